// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/flow_term.h>

namespace Gemmule
{
/**
 * Penalty Lambda (L - L0) on the arclength L (area in 3D), taken implicitly: a uniform tension
 * s = Lambda (L - L0 + dt dL/dt), that of the end of a time step of size dt, with dL/dt = int div_s <u>. With
 * Lambda infinite it is the Lagrange multiplier of dL/dt = -(L - L0)/dt.
 */
template <int dim>
class ArclengthConstraint : public FlowTerm<dim>
{
public:
  using typename FlowTerm<dim>::Vector;
  using typename FlowTerm<dim>::Velocity;
  using typename FlowTerm<dim>::Response;

  struct Penalty
  {
    double stiffness; ///< Lambda > 0, may be infinite
    double excess;    ///< L - L0 of the membrane for which the flow is solved
    double time_step; ///< dt; 0 makes the penalty explicit
  };

  ArclengthConstraint(const Penalty &penalty, const double capillary_number)
      : penalty(penalty), capillary_number(capillary_number)
  {
  }

  bool has_unit_force() const override { return true; }
  void add_unit_force(const FlowTermContext<dim> &context, Vector &right_side) const override;
  double find_amplitude(const FlowTermContext<dim> &context, const Response &response) override;

  /** s int div_s <u>. */
  double power(const InterfaceVelocity<dim> &interface_velocity, const Velocity &velocity) const override
  {
    return uniform_tension * interface_velocity.integrate_divergence(nullptr, velocity);
  }

  /** s of the last flow. */
  double tension() const { return uniform_tension; }
  /** The part of <u> per unit of s. */
  const Velocity &velocity_of_unit_tension() const { return unit_velocity; }

private:
  const Penalty penalty;
  const double capillary_number;
  double uniform_tension = 0.;
  Velocity unit_velocity;
};
} // namespace Gemmule
