// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/membrane_force.h>

namespace Gemmule
{
/**
 * Damps the fast shape modes of the explicit coupling of membrane and flow: adds
 *
 *   (S dt / Ca) int_Gamma max(sigma, 0) P grad(w) n . P grad <v> n + E div_s w div_s <v>,
 *   w = <u> - u_old,  P = I - n n^T,
 *
 * to the flow problem: S dt times the linearised stiffness of the tension against normal displacements and of
 * the membrane against dilatation. u_old is the velocity of the same material points one step ago, so that
 * the term is O(dt^2) and the scheme stays second order. In the linear model (decay rate lambda, BDF2 with
 * extrapolated velocity) the coupling is stable for dt lambda < 4/3 with S = 0, < 6.7 with S = 0.3 and for
 * every step with S >= 0.4 (doc/method.md).
 */
template <int dim>
struct SemiImplicitTension
{
  using NodalVelocity = std::array<dealii::Tensor<1, dim>, TensorLagrange<dim, 3>::n>;

  double coefficient = 0.;                                   ///< S dt
  const MembranePointValues *tension = nullptr;              ///< sigma
  const MembranePointValues *dilatational_modulus = nullptr; ///< E = -d sigma / d log(length); nullptr: 0
  const std::vector<NodalVelocity> *old_velocity = nullptr;  ///< u_old on the cut cells, Q3

  /** Adds the matrices of the cut cells to the system, and what they do to boundary values to @p rhs. */
  void add_matrix(const CutGeometry<dim> &geometry, const MembraneForce<dim> &force, double capillary_number,
                  const FluidPair &fluids, const std::vector<StokesCellElement> &cut_cell_elements,
                  ElementSystem &system, std::vector<double> &rhs) const;

  /** Adds this rank's part of the right side, that of u_old. */
  void add_rhs(const CutGeometry<dim> &geometry, const MembraneForce<dim> &force, double capillary_number,
               const FluidPair &fluids, const std::vector<StokesCellElement> &cut_cell_elements,
               const ElementSystem &system, std::vector<double> &rhs) const;
};
} // namespace Gemmule
