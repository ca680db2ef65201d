// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/time/step_control.h>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace Gemmule
{
namespace
{
  constexpr double unlimited = std::numeric_limits<double>::max();

  Parameters::TimeStepping parameters()
  {
    Parameters::TimeStepping p;
    p.initial_step = 0.01;
    p.smallest_step = 1e-4;
    p.largest_step = 0.08;
    return p;
  }
} // namespace

TEST(StepControl, HitsAllStopsExactlyAndEnds)
{
  StepControl control(parameters(), 0., {1., 0.3, 0.1234, 1.});
  std::vector<double> times;
  while (!control.finished())
  {
    EXPECT_GT(control.propose(unlimited), 1e-4);
    ASSERT_TRUE(control.judge(0.1));
    times.push_back(control.time());
  }
  for (const double stop : {0.1234, 0.3, 1.})
    EXPECT_EQ(std::count(times.begin(), times.end(), stop), 1) << stop;
  EXPECT_EQ(times.back(), 1.);
}

TEST(StepControl, GrowsToTheLargestStepAndRespectsTheStabilityLimit)
{
  StepControl control(parameters(), 0., {100.});
  double previous = control.propose(unlimited);
  for (unsigned int i = 0; i < 25; ++i)
  {
    const double step = control.propose(unlimited);
    EXPECT_LE(step, (step <= 0.01 ? 2. : 1.5) * previous * (1. + 1e-12));
    previous = step;
    control.judge(1e-6);
  }
  EXPECT_DOUBLE_EQ(previous, 0.08);
  EXPECT_DOUBLE_EQ(control.propose(0.02), 0.02);
}

TEST(StepControl, StartsWithSmallStepsThatDoubleUpToTheInitialOne)
{
  for (const bool adaptive : {false, true})
  {
    auto p = parameters();
    p.adaptive = adaptive;
    StepControl control(p, 0., {1.});
    for (const double part : {1. / 16., 1. / 16., 1. / 8., 1. / 4., 1. / 2., 1.})
    {
      EXPECT_DOUBLE_EQ(control.propose(unlimited), part * p.initial_step);
      ASSERT_TRUE(control.judge(0.5));
    }
    EXPECT_DOUBLE_EQ(control.time(), 2. * p.initial_step);
  }
}

TEST(StepControl, NeverStartsBelowTheSmallestStep)
{
  auto p = parameters();
  p.smallest_step = 0.4 * p.initial_step;
  StepControl control(p, 0., {1.});
  for (const double part : {0.5, 0.5, 1.})
  {
    EXPECT_DOUBLE_EQ(control.propose(unlimited), part * p.initial_step);
    ASSERT_TRUE(control.judge(0.5));
  }
}

TEST(StepControl, GrowsSlowlyAfterARemainder)
{
  // BDF2 is not stable for the ratio of a whole step to what is left between two stops that nearly coincide.
  for (const bool adaptive : {false, true})
  {
    auto p = parameters();
    p.adaptive = adaptive;
    StepControl control(p, 0., {0.1, 0.1005, 1.});
    double last = 0.;
    bool was_cut = false;
    while (!control.finished())
    {
      const double step = control.propose(unlimited);
      if (last > 0.)
      {
        EXPECT_LE(step, 2.4 * last * (1. + 1e-12)) << "at " << control.time();
      }
      was_cut = was_cut || step < 0.06 * last;
      last = step;
      ASSERT_TRUE(control.judge(0.5));
    }
    EXPECT_TRUE(was_cut);
  }
}

TEST(StepControl, OfFixedSizeForgetsAFailure)
{
  auto p = parameters();
  p.adaptive = false;
  StepControl control(p, 0., {10.});
  for (unsigned int i = 0; i < 3; ++i)
  {
    control.propose(unlimited);
    control.judge(0.5);
  }
  control.propose(unlimited);
  control.fail("for this test.");
  for (unsigned int i = 0; i < 6; ++i)
  {
    control.propose(unlimited);
    control.judge(0.5);
  }
  EXPECT_DOUBLE_EQ(control.propose(unlimited), p.initial_step);
}

TEST(StepControl, RepeatsABadStepSmallerAndStaysWhereItIs)
{
  StepControl control(parameters(), 0.5, {2.});
  const double step = control.propose(unlimited);
  EXPECT_FALSE(control.judge(8.));
  EXPECT_EQ(control.time(), 0.5);
  EXPECT_NEAR(control.propose(unlimited), 0.45 * step, 1e-12);
  EXPECT_TRUE(control.judge(0.9));
  EXPECT_GT(control.time(), 0.5);
}

TEST(StepControl, DoesNotChaseAnErrorThatIsNotOneOfTime)
{
  // An estimate with a part that no step size reduces, five times the tolerance.
  StepControl control(parameters(), 0., {0.5});
  unsigned int n_attempts = 0;
  while (!control.finished())
  {
    const double step = control.propose(unlimited);
    control.judge(5. + std::pow(step / 0.05, 3));
    ASSERT_LT(++n_attempts, 150u); // 50 steps of the initial size, and then some
  }
  EXPECT_GT(control.noise_floor(), 1.);
}

TEST(StepControl, DoesNotShrinkForEverWhereTheEstimateIsMostlyNoise)
{
  // Estimates between 0.3 and 1.2 times the tolerance whatever the step, or from 20 to 60, with a part of
  // time.
  for (const double level : {0.3, 20.})
  {
    StepControl control(parameters(), 0., {1e4});
    std::mt19937 generator(11);
    std::uniform_real_distribution<double> noise(level, 3. * level + 0.3);
    unsigned int n_steps = 0, n_tries = 0;
    double smallest = 1.;
    while (n_steps < 400)
    {
      const double step = control.propose(unlimited);
      ++n_tries;
      if (control.judge(noise(generator) + std::pow(step / 0.05, 3)))
      {
        ++n_steps;
        if (n_steps > 20)
          smallest = std::min(smallest, step);
      }
    }
    EXPECT_GT(smallest, 4e-4) << level;
    EXPECT_GT(control.time() / n_steps, 5e-3) << level;
    EXPECT_LT(n_tries, 2 * n_steps) << level;
  }
}

TEST(StepControl, SoonForgetsWhatAChangeOfTheMeshHasShown)
{
  StepControl control(parameters(), 0., {10.});
  for (unsigned int i = 0; i < 12; ++i)
  {
    control.propose(unlimited);
    ASSERT_TRUE(control.judge(0.7));
  }
  const double usual = control.propose(unlimited);
  EXPECT_FALSE(control.judge(20., true));
  control.propose(unlimited);
  EXPECT_TRUE(control.judge(20., true)) << "no step size helps";
  EXPECT_GT(control.noise_floor(), 10.);
  unsigned int n_steps = 0;
  for (; control.noise_floor() > 0.; ++n_steps)
  {
    EXPECT_LE(control.propose(unlimited), usual) << "no larger steps on its account";
    ASSERT_TRUE(control.judge(0.3, n_steps < 2));
    ASSERT_LT(n_steps, 12u);
  }
}

TEST(StepControl, TakesTheRemainderBeforeAStopAsItIs)
{
  // Shorter than the smallest step, and with an error that it cannot help.
  auto p = parameters();
  p.smallest_step = 0.005;
  StepControl control(p, 0., {0.001, 1.});
  EXPECT_DOUBLE_EQ(control.propose(unlimited), 0.001);
  EXPECT_TRUE(control.judge(3.));
  EXPECT_GE(control.propose(unlimited), 0.005);
}

TEST(StepControl, HalvesAfterAFailureAndGivesUpAtTheSmallestStep)
{
  StepControl control(parameters(), 0., {2.});
  double step = control.propose(unlimited);
  control.fail("no convergence.");
  EXPECT_DOUBLE_EQ(control.propose(unlimited), 0.5 * step);
  const auto go_on = [&]
  {
    for (unsigned int i = 0; i < 20; ++i)
    {
      control.propose(unlimited);
      control.fail("no convergence.");
    }
  };
  EXPECT_THROW(go_on(), SimulationError);
}

TEST(StepControl, GivesEachReasonItsOwnRemedy)
{
  auto p = parameters();
  p.smallest_step = p.initial_step;
  const auto message_of = [&](const auto &attempt)
  {
    StepControl control(p, 0., {2.});
    control.propose(unlimited);
    try
    {
      attempt(control);
    }
    catch (const SimulationError &error)
    {
      return std::string(error.what());
    }
    return std::string("none");
  };
  const std::string start =
      "The time step at t = 0 would have to be smaller than 'Smallest time step' = 0.01: ";
  EXPECT_EQ(message_of([](StepControl &control) { control.fail("A wall is reached. Use a larger box."); }),
            start + "A wall is reached. Use a larger box.");
  EXPECT_EQ(message_of([](StepControl &control) { control.fail("It breaks down.", "Refine the mesh."); }),
            start + "It breaks down. Refine the mesh.");
  EXPECT_EQ(message_of([](StepControl &control) { control.judge(8.); }),
            start + "the estimated local error is 8 times the tolerance. Refine the mesh, or loosen 'Time "
                    "stepping/Tolerance'.");
}

TEST(StepControl, KeepsTheStepWhenNotAdaptive)
{
  auto p = parameters();
  p.adaptive = false;
  StepControl control(p, 0., {0.1});
  unsigned int n = 0;
  while (!control.finished())
  {
    const double step = control.propose(1e-9);
    if (n > 4) // after the start
    {
      EXPECT_NEAR(step, 0.01, 1e-12);
    }
    EXPECT_TRUE(control.judge(1e9));
    ++n;
  }
  EXPECT_EQ(n, 14u);
}
} // namespace Gemmule
