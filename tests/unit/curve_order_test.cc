// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/geometry/curve_order.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace Gemmule
{
using namespace dealii;

TEST(CurveOrder, FindsTwoCirclesInShuffledUnevenPoints)
{
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> jitter(-0.49, 0.49);
  std::vector<std::pair<unsigned int, double>> parameters; // circle, angle
  const unsigned int n = 200;
  for (unsigned int circle = 0; circle < 2; ++circle)
    for (unsigned int i = 0; i < n; ++i)
      parameters.emplace_back(circle, 2. * numbers::PI * (i + jitter(generator)) / n);
  std::shuffle(parameters.begin(), parameters.end(), generator);

  std::vector<Point<2>> points;
  std::vector<Tensor<1, 2>> normals;
  for (const auto &[circle, angle] : parameters)
  {
    const Tensor<1, 2> n_out({std::cos(angle), std::sin(angle)});
    // the circles nearly touch
    points.push_back(Point<2>(circle == 0 ? -0.51 : 0.51, 0.) + 0.5 * n_out);
    normals.push_back(n_out);
  }
  const std::vector<double> spacing(points.size(), numbers::PI / n);
  const auto curves = order_closed_curves(points, normals, spacing);

  ASSERT_EQ(curves.size(), 2u);
  for (const auto &curve : curves)
  {
    ASSERT_EQ(curve.size(), n);
    double turned = 0.;
    for (unsigned int k = 0; k < n; ++k)
    {
      EXPECT_EQ(parameters[curve[k]].first, parameters[curve[0]].first);
      double step = parameters[curve[(k + 1) % n]].second - parameters[curve[k]].second;
      step -= 2. * numbers::PI * std::round(step / (2. * numbers::PI));
      EXPECT_GT(step, 0.);
      turned += step;
    }
    EXPECT_NEAR(turned, 2. * numbers::PI, 1e-10);
  }
}

TEST(CurveOrder, BeginsAtTheSamePointWhateverTheRoundOff)
{
  // Two circles of the same abscissa, symmetric about the axis: all extreme points come in pairs.
  const unsigned int n = 40;
  std::vector<Point<2>> points;
  std::vector<Tensor<1, 2>> normals;
  for (const double y : {0.6, -0.6})
    for (unsigned int i = 0; i < n; ++i)
    {
      const double angle = 2. * numbers::PI * (i + 0.5) / n;
      normals.push_back(Tensor<1, 2>({std::cos(angle), std::sin(angle)}));
      points.push_back(Point<2>(0., y) + 0.5 * normals.back());
    }
  const std::vector<double> spacing(points.size(), numbers::PI / n);
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> noise(-1e-13, 1e-13);
  for (unsigned int repetition = 0; repetition < 10; ++repetition)
  {
    auto disturbed = points;
    for (auto &p : disturbed)
      p[0] += noise(generator);
    const auto curves = order_closed_curves(disturbed, normals, spacing);
    ASSERT_EQ(curves.size(), 2u);
    EXPECT_EQ(curves[0].front(), n + n / 2); // the lower one of the left points, of the lower circle
    EXPECT_EQ(curves[1].front(), n / 2);
  }
}

TEST(CurveOrder, FindsOneWrinkledCurveWithPointsInExcess)
{
  // Waves as short as a few points, and here and there a second point beside the first that is not ahead of
  // it.
  std::vector<Point<2>> points;
  std::vector<Tensor<1, 2>> normals;
  const unsigned int n = 600, n_waves = 40;
  for (unsigned int i = 0; i < n; ++i)
  {
    const double angle = 2. * numbers::PI * i / n, amplitude = 0.01;
    const double radius = 0.5 + amplitude * std::cos(n_waves * angle),
                 slope = -amplitude * n_waves * std::sin(n_waves * angle);
    const Tensor<1, 2> radial({std::cos(angle), std::sin(angle)}), azimuthal({-radial[1], radial[0]});
    const Tensor<1, 2> normal = radius * radial - slope * azimuthal;
    for (unsigned int copy = 0; copy < (i % 17 == 0 ? 2u : 1u); ++copy)
    {
      normals.push_back(normal / normal.norm());
      points.push_back(Point<2>() + radius * radial + copy * 1e-7 * normals.back());
    }
  }
  const std::vector<double> spacing(points.size(), 2. * numbers::PI * 0.5 / n);
  const auto curves = order_closed_curves(points, normals, spacing);
  ASSERT_EQ(curves.size(), 1u);
  ASSERT_EQ(curves[0].size(), points.size());
  double length = 0.;
  for (unsigned int k = 0; k < points.size(); ++k)
    length += points[curves[0][k]].distance(points[curves[0][(k + 1) % points.size()]]);
  double exact = 0.; // of the polygon in the order in which the points were made
  for (unsigned int k = 0; k < points.size(); ++k)
    exact += points[k].distance(points[(k + 1) % points.size()]);
  EXPECT_NEAR(length, exact, 1e-5);
}

TEST(CurveOrder, OfNothingIsNothing)
{
  EXPECT_TRUE(order_closed_curves({}, {}, {}).empty());
}
} // namespace Gemmule
