// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/parameters/checkpoint.h>
#include <gemmule/parameters/output.h>

#include <vector>

namespace Gemmule
{
/**
 * At which times of a run membrane and fields are written. Writes nothing itself, and knows no simulation.
 *
 * Two times are the same if they differ by no more than 1e-8 of themselves and of the shortest interval
 * between outputs: multiples of two intervals that meet do so but for round-off, and StepControl does not
 * tell such times apart.
 */
class OutputSchedule
{
public:
  OutputSchedule(const Parameters::Output &output, double end_time);

  /** The times after the start that steps have to hit exactly, each once and in order; the last is the end.
   */
  const std::vector<double> &stops() const { return all_stops; }

  /** Is the membrane written at @p time, which is the start or one of the stops? */
  bool membrane_is_due(double time) const;

  /** The same for velocity and pressure in the box. */
  bool fields_are_due(double time) const;

private:
  bool is_same(double a, double b) const;
  bool is_listed(double time) const;
  bool is_multiple(double time, double interval) const;

  double field_interval, interface_interval;
  std::vector<double> listed_times;
  double end_time;
  double shortest_interval; ///< infinite if there is none
  std::vector<double> all_stops;
};

/** After which steps a checkpoint is written. Writes nothing itself, and knows no clock. */
class CheckpointSchedule
{
public:
  explicit CheckpointSchedule(const Parameters::Checkpoint &parameters) : parameters(parameters) {}

  /** @param seconds of wall clock since the last checkpoint, or since the run began */
  bool is_due(unsigned int step, double seconds) const;

  /** The checkpoint of @p step exists. */
  void is_written(unsigned int step) { last_step = step; }

private:
  Parameters::Checkpoint parameters;
  unsigned int last_step = 0;
};
} // namespace Gemmule
