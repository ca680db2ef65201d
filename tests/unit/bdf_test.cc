// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/time/bdf.h>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

using namespace Gemmule;

namespace
{
/** Largest error of derivative and extrapolation for y = t^power at t = 0.7 with steps dt and dt / ratio. */
double error(const BdfCoefficients &bdf, const unsigned int power, const double dt, const double ratio)
{
  const auto y = [power](double t) { return std::pow(t, power); };
  const double t = 0.7, t1 = t - dt, t2 = t1 - dt / ratio;
  const double derivative = (bdf.a0 * y(t) + bdf.a1 * y(t1) + bdf.a2 * y(t2)) / dt;
  return std::max(std::abs(derivative - (power == 0 ? 0. : power * std::pow(t, power - 1.))),
                  power > 1 ? 0. : std::abs(bdf.e1 * y(t1) + bdf.e2 * y(t2) - y(t)));
}
} // namespace

TEST(Bdf, SecondOrderIsExactForParabolasAtAnyStepRatio)
{
  for (const double ratio : {0.3, 1., 1.7})
    for (const unsigned int power : {0, 1, 2})
      EXPECT_NEAR(error(BdfCoefficients::second_order(ratio), power, 0.1, ratio), 0., 1e-13);
  EXPECT_GT(error(BdfCoefficients::second_order(1.), 3, 0.1, 1.), 1e-3);
}

TEST(Bdf, EqualStepsGiveTheUsualCoefficients)
{
  const auto bdf = BdfCoefficients::second_order(1.);
  EXPECT_DOUBLE_EQ(bdf.a0, 1.5);
  EXPECT_DOUBLE_EQ(bdf.a1, -2.);
  EXPECT_DOUBLE_EQ(bdf.a2, 0.5);
  EXPECT_EQ(bdf.order(), 2u);
}

TEST(Bdf, FirstOrderIsBackwardEuler)
{
  const auto bdf = BdfCoefficients::first_order();
  EXPECT_EQ(bdf.order(), 1u);
  EXPECT_NEAR(error(bdf, 0, 0.1, 1.), 0., 1e-15);
  EXPECT_NEAR((bdf.a0 * 0.7 + bdf.a1 * 0.6) / 0.1, 1., 1e-13);
}
