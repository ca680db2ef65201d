#include <gemmule/parameters/errors.h>
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
} // namespace

StepControl::StepControl(const Parameters::TimeStepping &parameters, const double start_time,
                         std::vector<double> stops_)
    : parameters(parameters), stops(std::move(stops_)), state{start_time, parameters.initial_step}
{
  Assert(!stops.empty(), dealii::ExcMessage("There must be an end."));
  std::sort(stops.begin(), stops.end());
}

double StepControl::propose(const double stability_limit)
{
  double step = std::min(state.wanted, parameters.largest_step);
  if (parameters.adaptive)
    step = std::min(step, stability_limit);
  const auto next = std::upper_bound(stops.begin(), stops.end(), state.now + same * step);
  const double left = (next == stops.end() ? stops.back() : *next) - state.now;
  if (step >= left * (1. - same))
    step = left;
  else if (step > 0.5 * left)
    step = 0.5 * left;
  proposed = step;
  return step;
}

void StepControl::shrink(const double factor, const std::string &reason)
{
  if (proposed <= parameters.smallest_step * (1. + same))
  {
    std::ostringstream message;
    message << "The time step at t = " << state.now
            << " would have to be smaller than 'Smallest time step' = " << parameters.smallest_step << ": "
            << reason << " Refine the mesh, or loosen 'Time stepping/Tolerance'.";
    throw SimulationError(message.str());
  }
  state.wanted = std::max(factor * proposed, parameters.smallest_step);
}

bool StepControl::judge(const double estimate)
{
  // Whether it is good enough is measured by what can be reached, the step by the part that depends on it.
  const double error = estimate / std::max(1., 1.5 * state.floor);
  const double ideal = safety * std::pow(std::max(estimate - state.floor, 1e-10), -1. / order_of_local_error);
  if (parameters.adaptive && error > 1.)
  {
    const bool falls =
        state.rejected_step == 0. || estimate < state.rejected_error * proposed / state.rejected_step;
    if (falls)
    {
      state.rejected_step = proposed;
      state.rejected_error = estimate;
      std::ostringstream reason;
      reason << "the estimated local error is " << estimate << " times the tolerance.";
      shrink(std::clamp(ideal, 0.2, 0.7), reason.str());
      return false;
    }
    state.floor = std::max(state.floor, estimate);
    state.wanted = state.rejected_step;
  }
  else if (parameters.adaptive)
  {
    state.floor = state.floor < 0.1 ? 0. : fading * state.floor;
    state.wanted = std::min(std::max(proposed * std::min(ideal, parameters.largest_growth),
                                     // a step cut short by a stop says little about what is possible
                                     ideal >= 1. ? std::min(state.wanted, proposed * ideal) : 0.),
                            parameters.largest_step);
  }
  state.rejected_step = 0.;

  const auto next = std::upper_bound(stops.begin(), stops.end(), state.now + same * proposed);
  state.now += proposed;
  // exactly on the stop, so that round-off does not add up
  if (next != stops.end() && std::abs(*next - state.now) < same * proposed)
    state.now = *next;
  return true;
}

void StepControl::fail(const std::string &reason)
{
  shrink(0.5, reason);
}
} // namespace Gemmule
