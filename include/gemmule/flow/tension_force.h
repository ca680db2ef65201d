// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/flow_term.h>

namespace Gemmule
{
/**
 * The force of the tension, -(1/Ca) int sigma div_s <v>, which needs neither curvature nor derivatives of the
 * tension (doc/method-flow.md).
 */
template <int dim>
class TensionForce : public FlowTerm<dim>
{
public:
  using typename FlowTerm<dim>::Vector;
  using typename FlowTerm<dim>::Velocity;

  /** @param tension sigma at the quadrature points of the membrane */
  TensionForce(MembranePointValues tension, const double capillary_number)
      : tension(std::move(tension)), capillary_number(capillary_number)
  {
  }

  void add_right_side(const FlowTermContext<dim> &context, Vector &right_side) const override;

  /** int sigma div_s <u>. */
  double power(const InterfaceVelocity<dim> &interface_velocity, const Velocity &velocity) const override
  {
    return interface_velocity.integrate_divergence(&tension, velocity);
  }

  /** right_side -= (1/Ca) int sigma div_s <v>. @param sigma nullptr for one */
  static void add_tension(const InterfaceVelocity<dim> &interface_velocity, const LinearSystem &system,
                          const MembranePointValues *sigma, double capillary_number, Vector &right_side);

private:
  const MembranePointValues tension;
  const double capillary_number;
};
} // namespace Gemmule
