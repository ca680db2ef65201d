// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/flow_term.h>

#include <memory>

namespace Gemmule
{
/**
 * Damps the fast shape modes of the explicit coupling of bending and flow: adds to the flow problem
 *
 *   (S dt k / Ca) int grad_s z . (grad_s <v>)^T n,     int z y + h int_active (n.grad z)(n.grad y)
 *                                                      = int grad_s y . (grad_s w)^T n   for all y,
 *
 * w = <u> - u_old as in SemiImplicitTension: S dt times the linearised bending stiffness, since z is the rate
 * of change of the curvature in the same trace space in which the bending force has it. With the largest
 * rigidity k the damping is as strong as needed everywhere. z enters the flow system as an additional
 * unknown on the cut cells, scaled with sqrt(S dt k / Ca), which keeps the matrix symmetric.
 *
 * The part of u_old is filtered by 2F - F^2, F = (1 - h^2 Laplace_s)^{-1}: waves of many cells keep their
 * past up to (h k)^4, those of a cell, which are mostly errors of the transfer between two mesh positions,
 * lose it. A time step is then not limited by h^3 (doc/method.md).
 */
template <int dim>
class SemiImplicitBending : public FlowTerm<dim>
{
public:
  using typename FlowTerm<dim>::Vector;
  using NodalVelocity = std::array<dealii::Tensor<1, dim>, TensorLagrange<dim, 3>::n>;

  /**
   * @param coefficient S dt k
   * @param space whose active mesh is the cut cells
   * @param old_velocity u_old on the cut cells, Q3
   */
  SemiImplicitBending(double coefficient, std::shared_ptr<const TraceSpace<dim>> space,
                      std::vector<NodalVelocity> old_velocity, double capillary_number);

  /** The space of z. */
  const TraceSpace<dim> *extra_field_space() const override { return space.get(); }
  std::unique_ptr<ExtraFieldPreconditioner>
  extra_field_preconditioner(const FluidPair &fluids) const override;
  void add_matrix(const FlowTermContext<dim> &context, Vector &right_side) const override;
  /** The part of u_old. */
  void add_right_side(const FlowTermContext<dim> &context, Vector &right_side) const override;

private:
  const double scale; ///< sqrt(S dt k / Ca)
  const std::shared_ptr<const TraceSpace<dim>> space;
  const std::vector<NodalVelocity> old_velocity;
};
} // namespace Gemmule
