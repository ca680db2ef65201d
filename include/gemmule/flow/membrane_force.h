// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/membrane_velocity.h>
#include <gemmule/flow/stokes_assembler.h>
#include <gemmule/geometry/cut_geometry.h>

#include <vector>

namespace Gemmule
{
/**
 * The surface divergence of <v> on the membrane and the functionals made of it: the force of the tension
 * -(1/Ca) int sigma div_s <v>, which needs neither curvature nor derivatives of the tension, the rate of
 * change of the arclength int div_s <u>, and the work of the tension (design section 1).
 */
template <int dim>
class MembraneForce
{
public:
  using Layout = StokesLayout<dim>;
  using Velocity = std::vector<MembraneVelocity<dim>>;

  /** Tabulates (I - n n^T) grad phi at the quadrature points. @p geometry must stay as long as this is used.
   */
  void reinit(const CutGeometry<dim> &geometry);

  /**
   * Adds this rank's part of -(1/Ca) int (sigma + offset) div_s <v>.
   * @param tension sigma; nullptr for zero
   */
  void add_rhs(const MembranePointValues *tension, double offset, double capillary_number,
               const FluidPair &fluids, const std::vector<StokesCellElement> &cut_cell_elements,
               const ElementSystem &system, std::vector<double> &rhs) const;

  /** <u> = w2 u1 + w1 u2 on the locally owned cut cells from the unknowns of the system; @p homogeneous: of a
   * solution with zero velocity at the walls. */
  Velocity average(const FluidPair &fluids, const std::vector<StokesCellElement> &cut_cell_elements,
                   const ElementSystem &system, const std::vector<double> &unknowns,
                   bool homogeneous = false) const;

  /** int (sigma + offset) div_s <u>: this rank's part. With sigma = 0, offset = 1 the rate of change of
   * arclength. */
  double integrate_divergence(const MembranePointValues *tension, double offset,
                              const Velocity &velocity) const;

  /** int <u>.n: this rank's part. */
  double integrate_flux(const Velocity &velocity) const;

  /** (I - n n^T) grad phi_i at point @p q of cut cell @p k, for the lexicographic Q2 nodes i. */
  const std::array<dealii::Tensor<1, dim>, Layout::n_velocity_nodes> &
  tangential_gradient(unsigned int k, unsigned int q) const
  {
    return tangential_gradients[first_point[k] + q];
  }

private:
  static constexpr unsigned int nv = Layout::n_velocity_nodes;

  const CutGeometry<dim> *geometry = nullptr;
  std::vector<std::size_t> first_point; ///< of each cut cell
  std::vector<std::array<dealii::Tensor<1, dim>, nv>> tangential_gradients;
};
} // namespace Gemmule
