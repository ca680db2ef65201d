// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/coupling/history.h>

#include <gtest/gtest.h>

using namespace Gemmule;

namespace
{
/** A level that can be told from others by its time and the size of its patch. */
MembraneSnapshot<2> level(const double time)
{
  MembraneSnapshot<2> snapshot;
  snapshot.time = time;
  snapshot.patches.resize(1);
  snapshot.patches[0].size = 10. * time;
  return snapshot;
}

void expect_coefficients(const BdfCoefficients &bdf, const BdfCoefficients &expected)
{
  EXPECT_EQ(bdf.a0, expected.a0);
  EXPECT_EQ(bdf.a1, expected.a1);
  EXPECT_EQ(bdf.a2, expected.a2);
  EXPECT_EQ(bdf.e1, expected.e1);
  EXPECT_EQ(bdf.e2, expected.e2);
}
} // namespace

TEST(History, BeginsWithALevelThatHasNoPast)
{
  History<2> history;
  history.begin(level(0.5), {1., 2.});
  EXPECT_EQ(history.time(), 0.5);
  EXPECT_EQ(history.last_step(), 0.);
  EXPECT_EQ(history.level_n_minus_1(), nullptr);
  EXPECT_EQ(history.limits().displacement, 2.);
  EXPECT_EQ(history.next_step(0.1).n_levels(), 1u);
  expect_coefficients(history.next_step(0.1).bdf(), BdfCoefficients::first_order());
}

TEST(History, HasTheCoefficientsOfTheStepsThatWereAccepted)
{
  History<2> history;
  history.begin(level(0.), {});
  history.accept(level(0.1), 0.1, {});
  ASSERT_NE(history.level_n_minus_1(), nullptr);
  EXPECT_EQ(history.next_step(0.15).n_levels(), 2u);
  expect_coefficients(history.next_step(0.15).bdf(), BdfCoefficients::second_order(0.15 / 0.1));

  history.accept(level(0.25), 0.15, {3., 4.});
  EXPECT_EQ(history.time(), 0.25);
  EXPECT_EQ(history.last_step(), 0.15);
  EXPECT_EQ(history.limits().capillary, 3.);
  EXPECT_EQ(history.level_n().patches[0].size, 2.5);
  EXPECT_EQ(history.level_n_minus_1()->time, 0.1);
  EXPECT_EQ(history.level_n_minus_1()->patches[0].size, 1.);
  const TimeStep step = history.next_step(0.2), expected(0.2, 0.15, 0.1);
  EXPECT_EQ(step.n_levels(), 3u);
  EXPECT_EQ(step.extrapolation(), expected.extrapolation());
  expect_coefficients(step.bdf(), BdfCoefficients::second_order(0.2 / 0.15));
}

TEST(History, ForgetsItsPastWhenItBeginsAnew)
{
  History<2> history;
  history.begin(level(0.), {});
  history.accept(level(0.1), 0.1, {});
  history.accept(level(0.2), 0.1, {});
  history.begin(level(0.2), {});
  EXPECT_EQ(history.level_n_minus_1(), nullptr);
  EXPECT_EQ(history.next_step(0.1).n_levels(), 1u);
  history.accept(level(0.3), 0.1, {});
  EXPECT_EQ(history.next_step(0.1).n_levels(), 2u) << "the steps before the new beginning do not count";
}

TEST(History, IsRestoredFromWhatWasAccepted)
{
  History<2> history, restored;
  history.begin(level(0.), {});
  history.accept(level(0.1), 0.1, {});
  history.accept(level(0.3), 0.2, {5., 6.});
  restored.restore(history.accepted());
  EXPECT_EQ(restored.time(), 0.3);
  EXPECT_EQ(restored.level_n_minus_1()->time, 0.1);
  EXPECT_EQ(restored.limits().displacement, 6.);
  EXPECT_EQ(restored.next_step(0.1).extrapolation(), history.next_step(0.1).extrapolation());
}
