// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/application/retry_policy.h>

namespace Gemmule
{
namespace
{
  // When a membrane that the mesh does not resolve is repaired: after so many attempts at one step, or when
  // steps are below so many times the smallest.
  constexpr unsigned int attempts_before_repair = 4;
  constexpr double small_steps = 100.;
  // In initial steps.
  constexpr double least_time_between_repairs = 0.1;
} // namespace

RetryPolicy::RetryPolicy(const Parameters::TimeStepping &parameters, const bool repairs_are_allowed)
    : parameters(parameters), repairs_are_allowed(repairs_are_allowed)
{
}

void RetryPolicy::attempt_failed()
{
  ++n_rejected;
  ++n_attempts;
}

bool RetryPolicy::may_repair(const double time, const double dt) const
{
  const bool is_hopeless =
      n_attempts >= attempts_before_repair || dt <= small_steps * parameters.smallest_step;
  return repairs_are_allowed && is_hopeless &&
         time >= last_repair + least_time_between_repairs * parameters.initial_step;
}
} // namespace Gemmule
