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

TEST(CurveOrder, OfNothingIsNothing)
{
  EXPECT_TRUE(order_closed_curves({}, {}, {}).empty());
}
} // namespace Gemmule
