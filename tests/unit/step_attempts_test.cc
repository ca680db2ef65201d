// SPDX-License-Identifier: LGPL-2.1-or-later
// How a step comes about, with a system that fails and errs as it is told.
#include <gemmule/application/step_attempts.h>

#include <iostream>
#include <sstream>

#include "support/output_test.h"

using namespace Gemmule;

namespace
{
Parameters::TimeStepping stepping()
{
  Parameters::TimeStepping parameters;
  parameters.initial_step = 1e-2;
  parameters.smallest_step = 1e-6;
  parameters.largest_step = 1e-2;
  return parameters;
}

/** Computes nothing. A membrane that is not resolved lets all steps fail. */
class ToldSystem : public TrialSystem
{
public:
  double longest_step() const override { return 1.; }
  StepErrors try_step(const double dt) override
  {
    sizes.push_back(dt);
    if (is_broken || dt > largest_that_succeeds)
      throw StepBreakdown("Newton's method does not converge.");
    if (is_at_wall)
      throw SimulationError("The membrane touches the wall. Choose a larger box.");
    return {shape_error(dt), composition_error(dt)};
  }
  bool mesh_is_new() const override { return false; }
  void accept() override { ++n_accepted; }
  bool membrane_is_resolved() const override
  {
    ++n_looks;
    return is_resolved;
  }
  RepairReport repair_membrane() override
  {
    ++n_repairs;
    if (cannot_be_repaired)
      throw SimulationError("nothing would be left.");
    is_broken = is_broken && !repair_helps;
    is_resolved = true;
    return {0.05, 3., 2.5};
  }
  std::string explanation_of_failure() const override { return explanation; }

  bool is_broken = false, is_at_wall = false, is_resolved = true;
  bool repair_helps = true, cannot_be_repaired = false;
  double largest_that_succeeds = 1.;
  std::function<double(double)> shape_error = [](double) { return 0.; },
                                composition_error = [](double) { return 0.; };
  std::string explanation;

  std::vector<double> sizes;
  unsigned int n_accepted = 0, n_repairs = 0;
  mutable unsigned int n_looks = 0;
};

class StepAttemptsTest : public OutputTest
{
protected:
  void SetUp() override
  {
    OutputTest::SetUp();
    log = std::make_unique<RunLog>(directory, MPI_COMM_WORLD, false,
                                   RunLog::Console(console, false, [] { return 0.; }));
    attempts = std::make_unique<StepAttempts>(system, control, policy, *log, tolerance);
  }

  std::string make_step()
  {
    return attempts->make_step(7, [] { return ""; });
  }
  std::string text() const { return content("log.txt"); }
  bool log_has(const std::string &part) const { return text().find(part) != std::string::npos; }

  static constexpr double tolerance = 1e-4;
  ToldSystem system;
  StepControl control{stepping(), 0., {1.}};
  RetryPolicy policy{stepping(), true};
  std::ostringstream console;
  std::unique_ptr<RunLog> log;
  std::unique_ptr<StepAttempts> attempts;
};
} // namespace

TEST_F(StepAttemptsTest, AGoodStepIsAcceptedAtOnceAndSilently)
{
  system.shape_error = [](double) { return 0.3 * tolerance; };
  EXPECT_EQ(make_step(), "");
  EXPECT_EQ(system.sizes.size(), 1u);
  EXPECT_EQ(system.n_accepted, 1u);
  EXPECT_EQ(control.time(), system.sizes[0]);
  EXPECT_EQ(attempts->errors().shape, 0.3 * tolerance);
  EXPECT_EQ(policy.memory().n_rejected, 0u);
  EXPECT_EQ(text(), "");
}

TEST_F(StepAttemptsTest, AStepThatCannotBeComputedIsHalvedUntilItCan)
{
  system.largest_that_succeeds = 2e-4;
  EXPECT_EQ(make_step(), "");
  EXPECT_EQ(system.sizes, (std::vector<double>{6.25e-4, 3.125e-4, 1.5625e-4}));
  EXPECT_EQ(system.n_accepted, 1u);
  EXPECT_EQ(control.time(), 1.5625e-4);
  EXPECT_EQ(policy.memory().n_rejected, 2u);
  EXPECT_EQ(policy.memory().n_attempts, 0u);
  EXPECT_TRUE(log_has("step 7 at t = 0, dt = 0.000625 failed and is repeated with half the size: Newton's "
                      "method does not converge."))
      << text();
}

TEST_F(StepAttemptsTest, AnInaccurateStepIsRepeatedShorterForTheLargerOfBothErrors)
{
  for (auto *const error : {&system.shape_error, &system.composition_error})
  {
    system.sizes.clear();
    *error = [](const double dt) { return dt > 4e-4 ? 2. * tolerance : 0.1 * tolerance; };
    EXPECT_EQ(make_step(), "");
    ASSERT_EQ(system.sizes.size(), 2u);
    EXPECT_LE(system.sizes[1], 0.7 * system.sizes[0]);
    *error = [](double) { return 0.; };
    control.restart();
  }
  EXPECT_EQ(policy.memory().n_rejected, 2u);
  EXPECT_TRUE(log_has("rejected: error of the shape 0.0002, of the composition 0, tolerance 0.0001"));
  EXPECT_TRUE(log_has("rejected: error of the shape 0, of the composition 0.0002, tolerance 0.0001"))
      << text();
}

TEST_F(StepAttemptsTest, AReasonToStopIsAskedForBeforeEachAttempt)
{
  system.is_broken = true;
  unsigned int n_asked = 0;
  EXPECT_EQ(attempts->make_step(1, [&] { return ++n_asked > 3 ? "signal SIGTERM" : ""; }), "signal SIGTERM");
  EXPECT_EQ(n_asked, 4u);
  EXPECT_EQ(system.sizes.size(), 3u);
  EXPECT_EQ(system.n_accepted, 0u);
}

TEST_F(StepAttemptsTest, TheSmallestStepThatBreaksDownEndsTheRunWithWhatHelps)
{
  system.is_broken = true;
  system.explanation = " The total concentration has all but vanished.";
  const std::string message = message_of([&] { make_step(); });
  EXPECT_EQ(message, "The time step at t = 0 would have to be smaller than 'Smallest time step' = 1e-06: "
                     "Newton's method does not converge. Refine the mesh, or allow shorter steps with 'Time "
                     "stepping/Smallest time step'. The total concentration has all but vanished.");
  EXPECT_EQ(system.sizes.back(), 1e-6);
  EXPECT_EQ(system.n_accepted, 0u);
}

TEST_F(StepAttemptsTest, AReasonWithARemedyOfItsOwnGetsNoOther)
{
  system.is_at_wall = true;
  system.explanation = " This is not said.";
  EXPECT_EQ(message_of([&] { make_step(); }),
            "The time step at t = 0 would have to be smaller than 'Smallest time step' = 1e-06: The membrane "
            "touches the wall. Choose a larger box.");
}

TEST_F(StepAttemptsTest, TheSmallestStepThatIsInaccurateEndsTheRunWithTheExplanation)
{
  system.shape_error = [](const double dt) { return 1e9 * dt * dt; };
  system.explanation = " The total concentration has all but vanished.";
  const std::string message = message_of([&] { make_step(); });
  EXPECT_NE(
      message.find("the estimated local error is 10 times the tolerance. Refine the mesh, or loosen 'Time "
                   "stepping/Tolerance'. The total concentration has all but vanished."),
      std::string::npos)
      << message;
}

TEST_F(StepAttemptsTest, WhatIsNoFailureOfTheSimulationIsPassedOn)
{
  system.shape_error = [](double) -> double { throw std::bad_alloc(); };
  EXPECT_THROW(make_step(), std::bad_alloc);
  EXPECT_EQ(policy.memory().n_rejected, 0u);
}

TEST_F(StepAttemptsTest, AnUnresolvedMembraneIsRepairedAndTheRunBeginsAnew)
{
  system.is_broken = true;
  system.is_resolved = false;
  EXPECT_EQ(make_step(), "");
  EXPECT_EQ(system.n_repairs, 1u);
  EXPECT_EQ(system.n_accepted, 1u);
  // Four attempts in vain, then the first step of a start.
  ASSERT_EQ(system.sizes.size(), 5u);
  EXPECT_EQ(system.sizes.back(), system.sizes.front());
  EXPECT_EQ(policy.memory().n_rejected, 4u);
  EXPECT_TRUE(log_has("the membrane at t = 0 has been repaired, and the run begins anew from there: what was "
                      "thinner than 0.1 is gone; arclength 3 before and 2.5 after."))
      << text();
  EXPECT_TRUE(log_has("warning: steps fail, and the mesh does not resolve the membrane since t = 0: it is "
                      "repaired ('Membrane/Repair unresolved shapes')"))
      << text();
}

TEST_F(StepAttemptsTest, AResolvedMembraneIsLeftAlone)
{
  system.is_broken = true;
  EXPECT_THROW(make_step(), SimulationError);
  EXPECT_GE(system.n_looks, 1u);
  EXPECT_EQ(system.n_repairs, 0u);
}

TEST_F(StepAttemptsTest, WhereRepairsAreNotAllowedNobodyLooks)
{
  RetryPolicy no_repairs(stepping(), false);
  StepAttempts without(system, control, no_repairs, *log, tolerance);
  system.is_broken = true;
  system.is_resolved = false;
  EXPECT_THROW(without.make_step(1, [] { return ""; }), SimulationError);
  EXPECT_EQ(system.n_looks, 0u);
  EXPECT_EQ(system.n_repairs, 0u);
}

TEST_F(StepAttemptsTest, ARepairThatIsImpossibleIsSaidAndTriedOnce)
{
  system.is_broken = true;
  system.is_resolved = false;
  system.cannot_be_repaired = true;
  EXPECT_THROW(make_step(), SimulationError);
  EXPECT_EQ(system.n_repairs, 1u);
  EXPECT_TRUE(log_has("the membrane at t = 0 cannot be repaired: nothing would be left.")) << text();
}

TEST_F(StepAttemptsTest, ARepairThatDoesNotHelpIsNotRepeatedAtTheSameTime)
{
  system.is_broken = true;
  system.is_resolved = false;
  system.repair_helps = false;
  EXPECT_THROW(make_step(), SimulationError);
  EXPECT_EQ(system.n_repairs, 1u);
}

TEST_F(StepAttemptsTest, AnUnresolvedMembraneIsRepairedAlsoWhereTheSmallestStepIsInaccurate)
{
  system.is_resolved = false;
  system.shape_error = [&](const double dt) { return system.n_repairs > 0 ? 0. : 1e9 * dt * dt; };
  EXPECT_EQ(make_step(), "");
  EXPECT_EQ(system.n_repairs, 1u);
  EXPECT_EQ(system.n_accepted, 1u);
}

TEST_F(StepAttemptsTest, AnErrorThatDoesNotFallIsToleratedWithOneWarning)
{
  system.composition_error = [](double) { return 3. * tolerance; };
  for (unsigned int step = 0; step < 3; ++step)
    EXPECT_EQ(make_step(), "");
  EXPECT_EQ(system.n_accepted, 3u);
  const std::string warning = "does not fall with the step size: it is one of the mesh, and tolerated.";
  const auto at = text().find(warning);
  ASSERT_NE(at, std::string::npos) << text();
  EXPECT_EQ(text().find(warning, at + 1), std::string::npos);
}
