// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/application/output_schedule.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Gemmule
{
namespace
{
  constexpr double same = 1e-8;
  // Of a time: multiples of a short interval have that much round-off when they become large.
  constexpr double round_off = 4. * std::numeric_limits<double>::epsilon();
} // namespace

OutputSchedule::OutputSchedule(const Parameters::Output &output, const double end_time)
    : field_interval(output.field_interval), interface_interval(output.interface_interval),
      listed_times(output.output_times), end_time(end_time),
      shortest_interval(std::numeric_limits<double>::infinity())
{
  for (const double interval : {field_interval, interface_interval})
    if (interval > 0.)
      shortest_interval = std::min(shortest_interval, interval);

  all_stops.push_back(end_time);
  const auto add = [this](const double time)
  {
    if (time > 0. && time < this->end_time)
      all_stops.push_back(time);
  };
  for (const double interval : {field_interval, interface_interval})
    for (unsigned int i = 1; interval > 0. && i * interval < end_time; ++i)
      add(i * interval);
  for (const double time : listed_times)
    add(time);
  std::sort(all_stops.begin(), all_stops.end());
  all_stops.erase(std::unique(all_stops.begin(), all_stops.end(),
                              [this](const double a, const double b) { return is_same(a, b); }),
                  all_stops.end());
  // What differs from the end by round-off is the end.
  all_stops.back() = end_time;
}

bool OutputSchedule::is_same(const double a, const double b) const
{
  const double size = std::max(std::abs(a), std::abs(b));
  return std::abs(a - b) <= std::max(same * std::min(size, shortest_interval), round_off * size);
}

bool OutputSchedule::is_listed(const double time) const
{
  return std::any_of(listed_times.begin(), listed_times.end(),
                     [&](const double other) { return is_same(time, other); });
}

bool OutputSchedule::is_multiple(const double time, const double interval) const
{
  return interval > 0. && is_same(time, interval * std::round(time / interval));
}

bool OutputSchedule::membrane_is_due(const double time) const
{
  return time >= end_time || is_multiple(time, interface_interval) || is_listed(time);
}

bool OutputSchedule::fields_are_due(const double time) const
{
  return (time >= end_time && field_interval > 0.) || is_multiple(time, field_interval) || is_listed(time);
}

bool CheckpointSchedule::is_due(const unsigned int step, const double seconds) const
{
  const bool by_steps = parameters.steps_between > 0 && step >= last_step + parameters.steps_between;
  const bool by_clock = parameters.wall_clock_interval > 0. && seconds >= parameters.wall_clock_interval;
  return by_steps || by_clock;
}
} // namespace Gemmule
