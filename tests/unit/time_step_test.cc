// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/time/time_step.h>

#include <cmath>
#include <gtest/gtest.h>

using namespace Gemmule;

namespace
{
// Steps of different sizes, newest first, and the times of the levels n, n-1, n-2 when level n+1 is at 1.
constexpr double dt = 0.1, dt1 = 0.07, dt2 = 0.13;
constexpr double t = 1., t_n = t - dt, t_n1 = t_n - dt1, t_n2 = t_n1 - dt2;

TimeStep step_with(const unsigned int n_levels)
{
  return n_levels == 1 ? TimeStep(dt) : n_levels == 2 ? TimeStep(dt, dt1) : TimeStep(dt, dt1, dt2);
}

double extrapolated(const TimeStep &step, const unsigned int power)
{
  const auto weights = step.extrapolation();
  return weights[0] * std::pow(t_n, power) + weights[1] * std::pow(t_n1, power) +
         weights[2] * std::pow(t_n2, power);
}
} // namespace

TEST(TimeStep, HasTheCoefficientsOfItsStepSizes)
{
  const auto first = step_with(1).bdf(), second = step_with(2).bdf(), third = step_with(3).bdf();
  EXPECT_EQ(first.order(), 1u);
  const auto expected = BdfCoefficients::second_order(dt / dt1);
  for (const auto &bdf : {second, third})
  {
    EXPECT_EQ(bdf.a0, expected.a0);
    EXPECT_EQ(bdf.a1, expected.a1);
    EXPECT_EQ(bdf.a2, expected.a2);
    EXPECT_EQ(bdf.e1, expected.e1);
    EXPECT_EQ(bdf.e2, expected.e2);
    EXPECT_NEAR(bdf.a0 * bdf.inverse_a0, 1., 1e-15);
  }
  EXPECT_EQ(first.inverse_a0, 1.);
}

TEST(TimeStep, ExtrapolatesAsExactlyAsThereAreLevels)
{
  for (const unsigned int n : {1u, 2u, 3u})
  {
    const TimeStep step = step_with(n);
    EXPECT_EQ(step.n_levels(), n);
    EXPECT_EQ(step.size(), dt);
    for (unsigned int power = 0; power < n; ++power)
      EXPECT_NEAR(extrapolated(step, power), 1., 1e-13) << n << " levels, power " << power;
    EXPECT_GT(std::abs(extrapolated(step, n) - 1.), 1e-3) << n << " levels";
    for (unsigned int k = n; k < 3; ++k)
      EXPECT_EQ(step.extrapolation()[k], 0.) << "a level that does not exist";
  }
}

TEST(TimeStep, TellsTheErrorOfBdf2FromItsDifferenceToTheExtrapolation)
{
  // y = t^3 / 6, for which both errors are their leading terms.
  const TimeStep step = step_with(3);
  const auto y = [](const double time) { return time * time * time / 6.; };
  const auto &bdf = step.bdf();
  const double by_bdf = (dt * t * t / 2. - bdf.a1 * y(t_n) - bdf.a2 * y(t_n1)) / bdf.a0;
  const double predicted = extrapolated(step, 3) / 6.;
  EXPECT_GT(std::abs(by_bdf - y(t)), 1e-5);
  EXPECT_NEAR(step.milne_factor() * (by_bdf - predicted), by_bdf - y(t), 1e-15);
  EXPECT_EQ(step_with(1).milne_factor(), 0.);
  EXPECT_EQ(step_with(2).milne_factor(), 0.);
}
