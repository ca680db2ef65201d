// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/arclength_constraint.h>
#include <gemmule/flow/tension_force.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
void ArclengthConstraint<dim>::add_unit_force(const FlowTermContext<dim> &context, Vector &right_side) const
{
  TensionForce<dim>::add_tension(context.interface_velocity, context.system, nullptr, capillary_number,
                                 right_side);
}

template <int dim>
double ArclengthConstraint<dim>::find_amplitude(const FlowTermContext<dim> &context, const Response &response)
{
  // u = y + s z, y the flow without penalty, z the flow of a unit tension. Solving s = Lambda (L - L0 + dt
  // l(y + s z)) for s first is free of cancellation for any Lambda; -l(z) is the work of the unit tension,
  // hence not negative.
  const double rate_without =
      Utilities::MPI::sum(context.interface_velocity.integrate_divergence(nullptr, response.velocity),
                          context.system.numbering().communicator());
  const double rate_of_unit = -capillary_number * response.unit_power;
  const double lambda = penalty.stiffness, dt = penalty.time_step;
  if (std::isinf(lambda))
    // On a circle no tension changes the length: the flow of a unit tension is round-off there, as is what
    // it would have to balance.
    uniform_tension =
        (penalty.excess / dt + rate_without) /
        std::max(-rate_of_unit, 1e-9 * context.interface_velocity.geometry().measure() / capillary_number);
  else
    uniform_tension = lambda * (penalty.excess + dt * rate_without) / (1. - lambda * dt * rate_of_unit);
  unit_velocity = response.unit_velocity;
  return uniform_tension;
}

template class ArclengthConstraint<2>;
template class ArclengthConstraint<3>;
} // namespace Gemmule
