// SPDX-License-Identifier: LGPL-2.1-or-later
// Bounds of expressions on cubes: no value and no slope that muParser's evaluation has may lie outside of
// them.
#include <gemmule/parameters/expression.h>
#include <gemmule/parameters/expression_bounds.h>
#include <gemmule/parameters/expression_names.h>

#include <deal.II/base/function.h>
#include <deal.II/base/point.h>

#include <cmath>
#include <gtest/gtest.h>
#include <random>

using namespace Gemmule;
using dealii::Point;

namespace
{
template <int dim>
struct Bounded
{
  std::unique_ptr<dealii::Function<dim>> function;
  ExpressionBounds<dim> bounds;

  explicit Bounded(const std::string &text)
      : function(make_function<dim>(text, 1, "Membrane/Level set", false)),
        bounds(*expression_tree<dim>(text))
  {
  }
};

/** Samples random cubes of [-1, 1]^dim, and random points in them. */
template <int dim>
void expect_values_within_bounds(const std::string &text)
{
  const Bounded<dim> f(text);
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> unit(0., 1.);
  for (unsigned int i = 0; i < 300; ++i)
  {
    const double size = std::pow(2., -8. * unit(generator));
    Point<dim> corner;
    for (unsigned int d = 0; d < dim; ++d)
      corner[d] = -1. + (2. - size) * unit(generator);
    const auto bounds = f.bounds.on_cube(corner, size);
    for (unsigned int j = 0; j < 20; ++j)
    {
      Point<dim> p = corner;
      for (unsigned int d = 0; d < dim; ++d)
        p[d] += size * (j == 0 ? 0. : unit(generator));
      const double value = f.function->value(p);
      if (!std::isfinite(value))
      {
        EXPECT_FALSE(bounds.is_defined) << text << " at " << p;
        continue;
      }
      ASSERT_LE(bounds.lower, value) << text << " at " << p;
      ASSERT_GE(bounds.upper, value) << text << " at " << p;
      for (unsigned int d = 0; d < dim; ++d)
      {
        const double step = 1e-5 * size;
        Point<dim> q = p;
        q[d] = std::min(p[d] + step, corner[d] + size);
        const double slope = (f.function->value(q) - value) / (q[d] - p[d]);
        const double round_off = 1e-14 * (1. + std::abs(value)) / step;
        if (!(q[d] > p[d]) || !std::isfinite(slope))
          continue;
        ASSERT_LE(bounds.lower_derivative[d], slope + round_off + 1e-7 * std::abs(slope))
            << text << " at " << p;
        ASSERT_GE(bounds.upper_derivative[d], slope - round_off - 1e-7 * std::abs(slope))
            << text << " at " << p;
      }
    }
  }
}

double width_on(const std::string &text, const double size)
{
  const auto bounds = Bounded<2>(text).bounds.on_cube(Point<2>(0.3, 0.4), size);
  return bounds.upper - bounds.lower;
}
} // namespace

TEST(ExpressionBounds, HoldForEveryFunctionThatExpressionsKnow)
{
  for (const auto &function : Parameters::expression_functions())
  {
    if (function.has_condition)
      continue;
    // Arguments from around zero, where many functions end, and beyond one.
    std::string call = function.name + "(";
    for (unsigned int i = 0; i < function.least_arguments; ++i)
      call += i == 0 ? "1.7*x+0.3*y" : ", y-0.2*x";
    expect_values_within_bounds<2>(call + ")");
    expect_values_within_bounds<2>(call + ")*x-y");
  }
}

TEST(ExpressionBounds, HoldForOperatorsPowersAndConditions)
{
  for (const std::string text : {"x^2+2*y^2-0.25",
                                 "-x^2",
                                 "x-y*x/(2+y)",
                                 "1/(x-0.3)",
                                 "x^3-y^-2",
                                 "(1.2+x)^0.5",
                                 "(1.2+x)^1.5",
                                 "2^x*y^0",
                                 "(x+1.5)^(y+0.1)",
                                 "if(x<0.2, x, y)",
                                 "x>y ? x*y : -y",
                                 "if(x<0.1 && y>=0 || !(x+y<=1), 1, x)",
                                 "if((x<0)==(y<0), x, y+2)",
                                 "if(x==y, 1, 2)",
                                 "if(x!=0.25, x, 2)",
                                 "min(x, y, x*y)-0.1",
                                 "max(x^2, abs(y), 0.1)",
                                 "sum(x, y, 1)*avg(x, y)",
                                 "atan2(y, x)",
                                 "atan2(y-0.1, x+2)",
                                 "exp(20*(x^2+2*y^2-0.25))-1",
                                 "sqrt(x^2+y^2)-0.4*(1+0.2*cos(3*atan2(y,x)))",
                                 "tanh(1e4*(x-y))",
                                 "pi*x+_e",
                                 "sin(x)/x",
                                 "tan(2*x)"})
    expect_values_within_bounds<2>(text);
  expect_values_within_bounds<3>("x^2+2*y^2+3*z^2-0.25*cos(x*z)");
}

TEST(ExpressionBounds, ShrinkWithTheCube)
{
  for (const std::string text : {"x^2+2*y^2-0.25", "exp(7*(x^2+2*y^2-0.25))-1",
                                 "sqrt(x^2+y^2)-0.4*cos(atan2(y,x))", "min(x^2, y^3)", "if(x<0.9, x*y, 1)"})
  {
    EXPECT_LT(width_on(text, 1e-3), 0.11 * width_on(text, 1e-2)) << text;
    EXPECT_LT(width_on(text, 1e-5), 0.011 * width_on(text, 1e-3)) << text;
  }
}

TEST(ExpressionBounds, ProveThatThereIsNoZeroFarFromAnEllipse)
{
  const Bounded<2> f("x^2+2*y^2-0.25");
  EXPECT_TRUE(f.bounds.on_cube(Point<2>(0.5, 0.1), 0.25).excludes_zero());
  EXPECT_TRUE(f.bounds.on_cube(Point<2>(-0.1, -0.1), 0.2).excludes_zero());
  EXPECT_FALSE(f.bounds.on_cube(Point<2>(0.4, 0.), 0.2).excludes_zero());
  EXPECT_TRUE(f.bounds.on_cube(Point<2>(0.4, 0.), 0.2).is_monotone());
  EXPECT_FALSE(f.bounds.on_cube(Point<2>(-0.1, -0.1), 0.2).is_monotone());
}
