// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/linear_system.h>
#include <gemmule/flow/cut_cell_matrix.h>
#include <gemmule/flow/membrane_velocity.h>
#include <gemmule/geometry/cut_geometry.h>

#include <array>
#include <vector>

namespace Gemmule
{
/**
 * The velocity <v> = w2 v1 + w1 v2 of the membrane on the cut cells, as a trial and as a test function: what
 * terms of the flow that live on the membrane are made of. It knows how <v> follows from the unknowns of the
 * flow, so that a term only deals with the Q2 nodal values of <v> (FlowTerm).
 */
template <int dim>
class InterfaceVelocity
{
public:
  using Layout = StokesLayout<dim>;
  using Vector = LinearSystem::Vector;
  static constexpr unsigned int n_nodes = Layout::n_velocity_nodes;
  /** A linear form of <v> on one cut cell: [i] for v = phi_i e_c in component c. */
  using NodalForce = std::array<dealii::Tensor<1, dim>, n_nodes>;
  /** A bilinear form of <v> and <u> on one cut cell: [i][j][c][d] for v = phi_i e_c, u = phi_j e_d. */
  using NodalMatrix = std::array<std::array<dealii::Tensor<2, dim>, n_nodes>, n_nodes>;
  using Velocity = std::vector<MembraneVelocity<dim>>;

  /** Tabulates (I - n n^T) grad phi at the quadrature points. @p geometry must stay as long as this is used.
   */
  void reinit(const CutGeometry<dim> &geometry);

  /**
   * Where the unknowns are.
   * @param elements the element of each cut cell in the system, which holds both fluids, inside first, in the
   * order of StokesLayout
   */
  void connect(const FluidPair &fluids, const std::vector<unsigned int> &elements);

  const CutGeometry<dim> &geometry() const { return *cut_geometry; }
  /** The element of cut cell @p k in the flow's system. */
  unsigned int element(const unsigned int k) const { return elements[k]; }

  /** (I - n n^T) grad phi_i at point @p q of cut cell @p k, for the lexicographic Q2 nodes i. Component c is
   * div_s (phi_i e_c). */
  const std::array<dealii::Tensor<1, dim>, n_nodes> &tangential_gradient(unsigned int k, unsigned int q) const
  {
    return tangential_gradients[first_point[k] + q];
  }

  /** <u> on the locally owned cut cells from a ghosted solution; @p homogeneous: of one with zero velocity at
   * the walls. */
  Velocity gather(const LinearSystem &system, const Vector &solution, bool homogeneous = false) const;

  /** right_side += the form @p force of <v> on cut cell @p k. */
  void scatter(unsigned int k, const NodalForce &force, const LinearSystem &system, Vector &right_side) const;

  /** matrix += the form @p form of <v> and <u> on cut cell @p k, and what it makes of velocities at the walls
   * to @p right_side. */
  void add_matrix(unsigned int k, const NodalMatrix &form, LinearSystem &system, Vector &right_side) const;

  /**
   * The form @p form of <v> = phi_i e_c and a scalar field psi_j, [i][j][c], and its transpose, in a local
   * matrix that has the unknowns of the cut cell's flow followed by those of the field.
   */
  template <std::size_t n_field>
  void set_coupling(const std::array<std::array<dealii::Tensor<1, dim>, n_field>, n_nodes> &form,
                    dealii::FullMatrix<double> &local) const;

  /** int sigma div_s <u>: this rank's part. @param sigma nullptr for one: the rate of change of arclength */
  double integrate_divergence(const MembranePointValues *sigma, const Velocity &velocity) const;

  /** int <u>.n: this rank's part. */
  double integrate_flux(const Velocity &velocity) const;

private:
  const CutGeometry<dim> *cut_geometry = nullptr;
  std::vector<std::size_t> first_point; ///< of each cut cell
  std::vector<std::array<dealii::Tensor<1, dim>, n_nodes>> tangential_gradients;
  std::array<double, 2> weights{{0., 0.}}; ///< of the fluids in <v>
  std::vector<unsigned int> elements;
  mutable dealii::FullMatrix<double> scratch;
};

template <int dim>
template <std::size_t n_field>
void InterfaceVelocity<dim>::set_coupling(
    const std::array<std::array<dealii::Tensor<1, dim>, n_field>, n_nodes> &form,
    dealii::FullMatrix<double> &local) const
{
  constexpr unsigned int first = 2 * Layout::n;
  for (unsigned int fluid = 0; fluid < 2; ++fluid)
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int i = 0; i < n_nodes; ++i)
        for (unsigned int j = 0; j < n_field; ++j)
        {
          const unsigned int row = fluid * Layout::n + Layout::velocity(c, i);
          local(row, first + j) = local(first + j, row) = weights[fluid] * form[i][j][c];
        }
}
} // namespace Gemmule
