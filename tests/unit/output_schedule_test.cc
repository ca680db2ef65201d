// SPDX-License-Identifier: LGPL-2.1-or-later
// When membrane, fields and checkpoints are written, without a run that writes them.
#include <gemmule/application/output_schedule.h>
#include <gemmule/time/step_control.h>

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>

using namespace Gemmule;

namespace
{
Parameters::Output outputs(const double field_interval, const double interface_interval,
                           const std::vector<double> &times = {})
{
  Parameters::Output output;
  output.field_interval = field_interval;
  output.interface_interval = interface_interval;
  output.output_times = times;
  return output;
}

/** At how many of the times that a run stops at, and at its start, something is written. */
struct Written
{
  unsigned int membranes = 0, fields = 0;
};

Written written(const OutputSchedule &schedule)
{
  std::vector<double> times = schedule.stops();
  times.push_back(0.);
  Written written;
  for (const double time : times)
  {
    written.membranes += schedule.membrane_is_due(time);
    written.fields += schedule.fields_are_due(time);
  }
  return written;
}
} // namespace

TEST(OutputSchedule, StopsAtAllMultiplesAndListedTimesInOrder)
{
  const OutputSchedule schedule(outputs(0.5, 0.25, {0.9, 0.1}), 1.);
  EXPECT_EQ(schedule.stops(), (std::vector<double>{0.1, 0.25, 0.5, 0.75, 0.9, 1.}));
}

TEST(OutputSchedule, WritesEachAtItsOwnMultiplesAndBothAtListedTimes)
{
  const OutputSchedule schedule(outputs(0.5, 0.25, {0.9}), 1.);
  for (const double time : {0., 0.25, 0.5, 0.75, 0.9, 1.})
    EXPECT_TRUE(schedule.membrane_is_due(time)) << time;
  for (const double time : {0., 0.5, 0.9, 1.})
    EXPECT_TRUE(schedule.fields_are_due(time)) << time;
  for (const double time : {0.25, 0.75, 0.4999, 0.901})
    EXPECT_FALSE(schedule.fields_are_due(time)) << time;
  for (const double time : {0.2, 0.2501, 0.9001})
    EXPECT_FALSE(schedule.membrane_is_due(time)) << time;
}

TEST(OutputSchedule, TheEndIsWrittenWhateverTheIntervals)
{
  const OutputSchedule uneven(outputs(0.3, 0.4), 1.);
  EXPECT_EQ(uneven.stops().back(), 1.);
  EXPECT_TRUE(uneven.membrane_is_due(1.));
  EXPECT_TRUE(uneven.fields_are_due(1.));

  // Without an interval there are fields at listed times only.
  const OutputSchedule none(outputs(0., 0.), 1.);
  EXPECT_EQ(none.stops(), std::vector<double>{1.});
  EXPECT_FALSE(none.membrane_is_due(0.));
  EXPECT_TRUE(none.membrane_is_due(1.));
  EXPECT_FALSE(none.fields_are_due(1.));
  EXPECT_TRUE(OutputSchedule(outputs(0., 0., {1.}), 1.).fields_are_due(1.));
}

TEST(OutputSchedule, AListedStartIsWrittenWithoutAStop)
{
  const OutputSchedule schedule(outputs(0., 0., {0.}), 1.);
  EXPECT_EQ(schedule.stops(), std::vector<double>{1.});
  EXPECT_TRUE(schedule.membrane_is_due(0.));
  EXPECT_TRUE(schedule.fields_are_due(0.));
}

TEST(OutputSchedule, TimesThatDifferByRoundOffAreOneStopAtEveryScale)
{
  // 3 * 0.1 is not 0.3, nor is 7 * 0.1 equal to 0.7, and so on.
  for (const double scale : {1e-12, 1e-9, 1e-3, 1., 1e3, 1e9})
  {
    std::vector<double> listed;
    for (unsigned int i = 1; i < 20; ++i)
      listed.push_back(scale * (i / 10.));
    const OutputSchedule schedule(outputs(0.1 * scale, 0.05 * scale, listed), 2. * scale);
    EXPECT_EQ(schedule.stops().size(), 40u) << scale;
    EXPECT_EQ(written(schedule).membranes, 41u) << scale;
    EXPECT_EQ(written(schedule).fields, 21u) << scale;
  }
}

TEST(OutputSchedule, AMillionOutputsAreAllWrittenOnce)
{
  // The last of them differ from multiples by more than 1e-10 of the interval.
  const OutputSchedule schedule(outputs(0.3e-6, 0.1e-6), 0.1);
  EXPECT_NEAR(schedule.stops().size(), 1000000., 1.);
  EXPECT_EQ(written(schedule).membranes, schedule.stops().size() + 1);
  EXPECT_NEAR(written(schedule).fields, 1000000. / 3. + 2., 1.);
}

TEST(OutputSchedule, ShortIntervalsLateInALongRunStayApart)
{
  // 1e-9 of the time is longer than the interval.
  Parameters::Output output = outputs(0., 1e-2, {});
  const double end = 9e3;
  const OutputSchedule schedule(output, end);
  EXPECT_EQ(schedule.stops().size(), 900000u);
  output.output_times = {end - 0.995e-2};
  EXPECT_EQ(OutputSchedule(output, end).stops().size(), 900001u);
}

TEST(OutputSchedule, OutputsOfAVeryShortRunStayApart)
{
  const OutputSchedule schedule(outputs(2e-10, 1e-10), 1e-9);
  EXPECT_EQ(schedule.stops().size(), 10u);
  EXPECT_EQ(written(schedule).membranes, 11u);
  EXPECT_EQ(written(schedule).fields, 6u);
  EXPECT_FALSE(OutputSchedule(outputs(0., 0., {1e-10}), 1e-9).membrane_is_due(0.));
}

TEST(OutputSchedule, WhatDiffersFromTheEndByRoundOffIsTheEnd)
{
  // 3 * 0.1 lies behind 0.3, and 0.7 * 3 before 2.1.
  EXPECT_EQ(OutputSchedule(outputs(0., 0.1), 0.3).stops(), (std::vector<double>{0.1, 0.2, 0.3}));
  EXPECT_EQ(OutputSchedule(outputs(0., 0.7), 2.1).stops(), (std::vector<double>{0.7, 1.4, 2.1}));
  EXPECT_EQ(OutputSchedule(outputs(0., 0., {1. - 1e-12}), 1.).stops(), std::vector<double>{1.});
}

TEST(OutputSchedule, IntervalsBeyondTheEndGiveStartAndEnd)
{
  const OutputSchedule schedule(outputs(10., 3.), 1.);
  EXPECT_EQ(schedule.stops(), std::vector<double>{1.});
  EXPECT_EQ(written(schedule).membranes, 2u);
  EXPECT_EQ(written(schedule).fields, 2u);
}

// Each output is written once when the step control takes the steps, however they fall.
TEST(OutputSchedule, TheStepControlMeetsEveryOutput)
{
  Parameters::TimeStepping stepping;
  stepping.initial_step = 1e-3;
  stepping.smallest_step = 1e-7;
  for (const auto &output : {outputs(0.5, 0.1), outputs(0.07, 0.03, {0.1, 0.21, 1. / 3.}),
                             outputs(0., 0., {1e-5, 0.4, 0.4 * (1. + 1e-7), 0.4 * (1. + 1e-9)}),
                             outputs(1. / 3., 1. / 7., {1. / 3. + 1e-11, 2. / 3.})})
    for (const double largest_step : {2e-3, 0.05, 1.})
    {
      stepping.largest_step = largest_step;
      const OutputSchedule schedule(output, 1.);
      StepControl control(stepping, 0., schedule.stops());
      Written found;
      const auto write = [&](const double time)
      {
        found.membranes += schedule.membrane_is_due(time);
        found.fields += schedule.fields_are_due(time);
      };
      write(0.);
      while (!control.finished())
      {
        control.propose(std::numeric_limits<double>::max());
        ASSERT_TRUE(control.judge(1e-3));
        write(control.time());
      }
      EXPECT_EQ(found.membranes, written(schedule).membranes);
      EXPECT_EQ(found.fields, written(schedule).fields);
    }
}

TEST(CheckpointSchedule, IsDueBySteps)
{
  Parameters::Checkpoint parameters;
  parameters.steps_between = 10;
  parameters.wall_clock_interval = 0.;
  CheckpointSchedule schedule(parameters);
  EXPECT_FALSE(schedule.is_due(9, 1e9));
  EXPECT_TRUE(schedule.is_due(10, 0.));
  EXPECT_TRUE(schedule.is_due(13, 0.));
  schedule.is_written(13);
  EXPECT_FALSE(schedule.is_due(20, 0.));
  EXPECT_TRUE(schedule.is_due(23, 0.));
}

TEST(CheckpointSchedule, IsDueByTheClock)
{
  Parameters::Checkpoint parameters;
  parameters.steps_between = 0;
  parameters.wall_clock_interval = 300.;
  const CheckpointSchedule schedule(parameters);
  EXPECT_FALSE(schedule.is_due(1000, 299.));
  EXPECT_TRUE(schedule.is_due(1, 300.));
}

TEST(CheckpointSchedule, IsNeverDueWithoutAnInterval)
{
  Parameters::Checkpoint parameters;
  parameters.steps_between = 0;
  parameters.wall_clock_interval = 0.;
  EXPECT_FALSE(CheckpointSchedule(parameters).is_due(1000000, 1e9));
}

TEST(CheckpointSchedule, EitherOfBothIsEnough)
{
  Parameters::Checkpoint parameters;
  parameters.steps_between = 5;
  parameters.wall_clock_interval = 60.;
  const CheckpointSchedule schedule(parameters);
  EXPECT_FALSE(schedule.is_due(4, 59.));
  EXPECT_TRUE(schedule.is_due(5, 0.));
  EXPECT_TRUE(schedule.is_due(0, 61.));
}
