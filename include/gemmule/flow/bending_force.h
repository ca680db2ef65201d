// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/flow_term.h>
#include <gemmule/surface/membrane_bending.h>

namespace Gemmule
{
/**
 * Force of the bending energy E_b = int w(kappa, c) on the fluid: -(1/Ca) dE_b[<v>] with the variation of
 * E_b under the displacement v at fixed composition of each material point (doc/model.md, "Bending"),
 *
 *   dE_b[v] = int grad_s m . (grad_s v)^T n - m grad_s n : grad_s v + w div_s v,   m = w_kappa = k (kappa -
 * kappa_0),
 *
 * in which only first derivatives of v and of the trace field m occur. In 2D grad_s n is kappa times the
 * tangential projection; in 3D its traceless part comes from the second derivatives of the level set.
 */
template <int dim>
class BendingForce : public FlowTerm<dim>
{
public:
  using typename FlowTerm<dim>::Vector;
  using typename FlowTerm<dim>::Velocity;

  /** @param bending curvature and moment on the membrane of the flow: copied */
  BendingForce(const MembraneBending<dim> &bending, double capillary_number);

  void add_right_side(const FlowTermContext<dim> &context, Vector &right_side) const override;

  /** dE_b[velocity]: the power that bending takes up; this rank's part. */
  double power(const InterfaceVelocity<dim> &interface_velocity, const Velocity &velocity) const override;

private:
  using NodalForce = typename InterfaceVelocity<dim>::NodalForce;

  /** dE_b[phi_i e_c] on cut cell @p k, [i][c]. */
  NodalForce variation(const InterfaceVelocity<dim> &interface_velocity, unsigned int k) const;

  const TraceField<dim> moment;
  const MembranePointValues curvature, moment_at_points, energy_density;
  const double capillary_number;
};
} // namespace Gemmule
