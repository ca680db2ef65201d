// SPDX-License-Identifier: LGPL-2.1-or-later
// When a membrane is looked at because steps fail, without a simulation.
#include <gemmule/application/retry_policy.h>

#include <gtest/gtest.h>

using namespace Gemmule;

namespace
{
/** Steps of some thousandths; repairs at least 1e-3 apart. */
Parameters::TimeStepping stepping()
{
  Parameters::TimeStepping parameters;
  parameters.initial_step = 1e-2;
  parameters.smallest_step = 1e-6;
  return parameters;
}

constexpr double ordinary_step = 1e-3, small_step = 1e-4;
} // namespace

TEST(RetryPolicy, AMembraneIsRepairedAfterSeveralAttemptsAtOneStep)
{
  RetryPolicy policy(stepping(), true);
  for (unsigned int attempt = 1; attempt <= 3; ++attempt)
  {
    policy.attempt_failed();
    EXPECT_FALSE(policy.may_repair(0., ordinary_step)) << attempt;
  }
  policy.attempt_failed();
  EXPECT_TRUE(policy.may_repair(0., ordinary_step));
}

TEST(RetryPolicy, AttemptsAtEarlierStepsDoNotCount)
{
  RetryPolicy policy(stepping(), true);
  for (unsigned int step = 0; step < 10; ++step)
  {
    for (unsigned int attempt = 0; attempt < 3; ++attempt)
    {
      policy.attempt_failed();
      EXPECT_FALSE(policy.may_repair(0.01 * step, ordinary_step));
    }
    policy.step_accepted();
  }
  EXPECT_EQ(policy.memory().n_rejected, 30u);
  EXPECT_EQ(policy.memory().n_attempts, 0u);
}

TEST(RetryPolicy, OneAttemptIsEnoughWhereStepsAreSmall)
{
  RetryPolicy policy(stepping(), true);
  policy.attempt_failed();
  EXPECT_FALSE(policy.may_repair(0., 1.01 * small_step));
  EXPECT_TRUE(policy.may_repair(0., 0.99 * small_step));
}

TEST(RetryPolicy, NothingIsRepairedWhereThatIsNotAllowed)
{
  RetryPolicy policy(stepping(), false);
  for (unsigned int attempt = 0; attempt < 10; ++attempt)
    policy.attempt_failed();
  EXPECT_FALSE(policy.may_repair(0., 1e-6));
}

TEST(RetryPolicy, ARepairThatHasNotHelpedIsNotRepeatedAtOnce)
{
  RetryPolicy policy(stepping(), true);
  for (unsigned int attempt = 0; attempt < 4; ++attempt)
    policy.attempt_failed();
  policy.repair_begins(0.5);
  policy.membrane_is_repaired();
  EXPECT_EQ(policy.memory().n_attempts, 0u);
  for (unsigned int attempt = 0; attempt < 4; ++attempt)
    policy.attempt_failed();
  EXPECT_FALSE(policy.may_repair(0.5, ordinary_step));
  EXPECT_FALSE(policy.may_repair(0.5009, 1e-6));
  EXPECT_TRUE(policy.may_repair(0.5011, ordinary_step));
}

TEST(RetryPolicy, AFailedRepairCountsAsOne)
{
  RetryPolicy policy(stepping(), true);
  for (unsigned int attempt = 0; attempt < 4; ++attempt)
    policy.attempt_failed();
  policy.repair_begins(0.);
  EXPECT_FALSE(policy.may_repair(0., ordinary_step));
  policy.attempt_failed();
  EXPECT_FALSE(policy.may_repair(0., 1e-6));
}

TEST(RetryPolicy, ARepairAtTheStartIsPossible)
{
  RetryPolicy policy(stepping(), true);
  policy.attempt_failed();
  EXPECT_TRUE(policy.may_repair(0., 1e-6));
}

TEST(RetryPolicy, AResumedRunDecidesTheSame)
{
  RetryPolicy policy(stepping(), true), resumed(stepping(), true);
  for (unsigned int attempt = 0; attempt < 3; ++attempt)
    policy.attempt_failed();
  policy.repair_begins(0.2);
  resumed.restore(policy.memory());
  for (RetryPolicy *const each : {&policy, &resumed})
    each->attempt_failed();
  for (const double time : {0.2, 0.2005, 0.202})
    for (const double dt : {ordinary_step, small_step, 1e-6})
      EXPECT_EQ(policy.may_repair(time, dt), resumed.may_repair(time, dt));
  EXPECT_TRUE(resumed.may_repair(0.202, ordinary_step));
  EXPECT_EQ(resumed.memory().n_rejected, 4u);
}
