// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/time/step_control.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Gemmule
{
namespace
{
  // Times closer than this, relative to the step, are the same: round-off of sums of steps.
  constexpr double same = 1e-9;
  constexpr double safety = 0.9;
  constexpr double order_of_local_error = 3.;
  // How fast an estimate that could not be reduced is forgotten, per step.
  constexpr double fading = 0.99;
  // The same when it comes from a change of the mesh, which later steps do not see.
  constexpr double fading_after_change = 0.5;
  // BDF2 is stable for ratios of successive steps up to 1 + sqrt(2).
  constexpr double largest_ratio = 2.4;
  // Halvings of the initial step for the first one, of first order.
  constexpr unsigned int largest_number_of_halvings = 4;
} // namespace

StepControl::StepControl(const Parameters::TimeStepping &parameters, const double start_time,
                         std::vector<double> stops_)
    : parameters(parameters), stops(std::move(stops_)), n_halvings(largest_number_of_halvings)
{
  now = start_time;
  Assert(!stops.empty(), dealii::ExcMessage("There must be an end."));
  std::sort(stops.begin(), stops.end());
  while (parameters.adaptive && n_halvings > 0 &&
         std::ldexp(parameters.initial_step, -static_cast<int>(n_halvings)) < parameters.smallest_step)
    --n_halvings;
  wanted = start_step();
}

double StepControl::start_step() const
{
  // the first size twice, then each the double of the one before: together one initial step
  const unsigned int n_doublings = n_started == 0 ? 0 : n_started - 1;
  return std::ldexp(parameters.initial_step, static_cast<int>(n_doublings) - static_cast<int>(n_halvings));
}

double StepControl::propose(const double stability_limit)
{
  double step = std::min(wanted, parameters.largest_step);
  if (parameters.adaptive)
    step = std::min(step, stability_limit);
  if (last_step > 0.) // which a stop may have cut to a remainder
    step = std::min(step, std::max(largest_ratio * last_step, parameters.smallest_step));
  const double whole_step = step;
  const auto next = std::upper_bound(stops.begin(), stops.end(), now + same * step);
  const double left = (next == stops.end() ? stops.back() : *next) - now;
  if (step >= left * (1. - same))
    step = left;
  else if (step > 0.5 * left)
    step = 0.5 * left;
  proposed = step;
  is_cut_short = step < whole_step;
  return step;
}

void StepControl::shrink(const double factor, const std::string &reason)
{
  if (proposed <= parameters.smallest_step * (1. + same))
  {
    std::ostringstream message;
    message << "The time step at t = " << now
            << " would have to be smaller than 'Smallest time step' = " << parameters.smallest_step << ": "
            << reason;
    throw SimulationError(message.str());
  }
  wanted = std::max(factor * proposed, parameters.smallest_step);
  n_started = n_halvings + 1;
}

bool StepControl::judge(const double estimate, const bool on_new_mesh)
{
  // Whether it is good enough is measured by what can be reached, the step by the part that depends on it.
  const double error = estimate / std::max(1., 1.5 * floor);
  const double ideal = safety * std::pow(std::max(estimate - floor, 1e-10), -1. / order_of_local_error);
  // A stop can cut a step below the smallest size; repeating it smaller is not possible, and it says nothing
  // about the size to go on with.
  const bool is_remainder = is_cut_short && proposed < parameters.smallest_step * (1. - same);
  if (parameters.adaptive && error > 1. && !is_remainder)
  {
    const bool falls = rejected_step == 0. || estimate < rejected_error * proposed / rejected_step;
    if (falls)
    {
      rejected_step = proposed;
      rejected_error = estimate;
      std::ostringstream reason;
      reason << "the estimated local error is " << estimate
             << " times the tolerance. Refine the mesh, or loosen "
                "'Time stepping/Tolerance'.";
      shrink(std::clamp(ideal, 0.2, 0.7), reason.str());
      return false;
    }
    floor_passes = on_new_mesh && (floor_passes || floor == 0.);
    floor = std::max(floor, estimate);
    wanted = rejected_step;
  }
  else if (parameters.adaptive && !is_remainder)
  {
    // Beside a floor that passes, an estimate says little: the step must not grow on its account.
    const double largest_growth = floor > 0. && floor_passes ? 1. : parameters.largest_growth;
    floor = floor < 0.1 ? 0. : (floor_passes ? fading_after_change : fading) * floor;
    // What was good enough is not made smaller: an estimate that does not depend on the step size would let
    // it shrink for ever, while a rejection finds that out.
    wanted = std::min(std::max(proposed * std::clamp(ideal, 1., largest_growth),
                               // a step cut short by a stop says little about what is possible
                               ideal >= 1. ? std::min(wanted, proposed * ideal) : 0.),
                      parameters.largest_step);
    wanted = std::max(wanted, parameters.smallest_step);
  }
  if (n_started <= n_halvings)
  {
    ++n_started;
    wanted = start_step();
  }
  else if (!parameters.adaptive)
    // A step that could not be computed says nothing about the next one.
    wanted = parameters.initial_step;
  rejected_step = 0.;
  last_step = proposed;

  const auto next = std::upper_bound(stops.begin(), stops.end(), now + same * proposed);
  now += proposed;
  // exactly on the stop, so that round-off does not add up
  if (next != stops.end() && std::abs(*next - now) < same * proposed)
    now = *next;
  return true;
}

void StepControl::restart()
{
  const double time_to_keep = now;
  restore(StepControlMemory());
  now = time_to_keep;
  wanted = start_step();
}

void StepControl::fail(const std::string &reason, const std::string &remedy)
{
  shrink(0.5, remedy.empty() ? reason : reason + " " + remedy);
}
} // namespace Gemmule
