// SPDX-License-Identifier: LGPL-2.1-or-later
// Finding the zero set of a level set, and its distance, whatever the level set is away from it.
#include <gemmule/geometry/zero_set_distance.h>
#include <gemmule/mesh/membrane_search.h>
#include <gemmule/parameters/expression.h>
#include <gemmule/parameters/expression_bounds.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <gtest/gtest.h>

using namespace Gemmule;
using namespace dealii;

namespace
{
/** What is found of @p text in the box [-1, 1]^dim, whose cells of level l have the edge 2^(1-l). */
template <int dim>
FoundMembrane<dim> find(const std::string &text, const typename MembraneSearch<dim>::Levels &levels)
{
  const auto function = make_function<dim>(text, 1, "Membrane/Level set", false);
  const ExpressionBounds<dim> bounds(*expression_tree<dim>(text));
  BoxLattice<dim> box;
  for (unsigned int d = 0; d < dim; ++d)
  {
    box.lower[d] = -1.;
    box.upper[d] = 1.;
  }
  box.coarse_size = 2.;

  const int n = 1 << levels.coarsest;
  const unsigned int rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD),
                     n_ranks = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  std::vector<LatticeKey<dim>> cubes;
  for (int i = 0; i < static_cast<int>(std::pow(n, dim)); ++i)
    if (i % n_ranks == rank)
    {
      LatticeKey<dim> key;
      for (int d = 0, rest = i; d < dim; ++d, rest /= n)
        key[d] = rest % n;
      cubes.push_back(key);
    }
  const MembraneSearch<dim> search(
      *function, [&](const Point<dim> &corner, const double size) { return bounds.on_cube(corner, size); },
      box, levels, 200000);
  return search.search(cubes, MPI_COMM_WORLD);
}

/** How many of the roots lie within @p distance of a point. */
template <int dim>
unsigned int count_near(const FoundMembrane<dim> &found, const Point<dim> &point, const double distance)
{
  return std::count_if(found.roots.begin(), found.roots.end(),
                       [&](const auto &root) { return root.point().distance(point) < distance; });
}

template <int dim>
std::vector<typename ZeroSetDistance<dim>::KnownPoint> known_points(const FoundMembrane<dim> &found)
{
  std::vector<typename ZeroSetDistance<dim>::KnownPoint> points;
  for (const auto &root : found.roots)
    points.push_back({root.point(), root.spacing});
  return points;
}
} // namespace

TEST(ParallelMembraneSearch, FindsEveryCellThatAnEllipseCrosses)
{
  const auto found = find<2>("x^2+2*y^2-0.25", {3, 6, 8});
  EXPECT_EQ(found.blind_size, 0.);
  const double h = 2. / 64.;
  for (unsigned int i = 0; i < 1000; ++i)
  {
    const double angle = 2. * numbers::PI * i / 1000.;
    const Point<2> p(0.5 * std::cos(angle), std::sqrt(0.125) * std::sin(angle));
    EXPECT_GT(count_near(found, p, 1.5 * h), 0u) << p;
  }
  for (const auto &root : found.roots)
    EXPECT_NEAR(std::pow(root.point()[0], 2) + 2. * std::pow(root.point()[1], 2), 0.25, 1e-12);
}

TEST(ParallelMembraneSearch, FindsCirclesOfTheFinestCellsWhereverTheyLie)
{
  // Radius of a finest cell, 1/40 of a cell of the coarsest mesh.
  const double radius = 2. / 256.;
  for (const Point<2> &center : {Point<2>(0.37, -0.41), Point<2>(-0.9, 0.91), Point<2>(0.001, 0.626)})
  {
    const std::string text = "min(x^2+y^2-0.09, (x-" + std::to_string(center[0]) + ")^2+(y-" +
                             std::to_string(center[1]) + ")^2-" + std::to_string(radius * radius) + ")";
    EXPECT_GT(count_near(find<2>(text, {2, 5, 8}), center, 2. * radius), 0u) << center;
  }
}

TEST(ParallelMembraneSearch, FindsAThinFilament)
{
  // 0.01 thick, between lattice points of all coarser levels.
  const auto found = find<2>("max(abs(x-0.0531)-0.005, abs(y)-0.5)", {2, 4, 8});
  for (const double y : {-0.45, -0.2, 0.01, 0.3, 0.49})
    EXPECT_GT(count_near(found, Point<2>(0.0531, y), 0.13), 0u) << y;
}

TEST(ParallelMembraneSearch, FindsSmallSpheresIn3D)
{
  const auto found = find<3>("min(x^2+y^2+z^2-0.2, (x-0.7)^2+(y-0.66)^2+(z+0.71)^2-0.001)", {2, 4, 6});
  EXPECT_GT(count_near(found, Point<3>(0.7, 0.66, -0.71), 0.1), 0u);
  EXPECT_GT(count_near(found, Point<3>(0., 0., std::sqrt(0.2)), 0.2), 0u);
  EXPECT_EQ(found.blind_size, 0.);
}

TEST(ParallelMembraneSearch, SaysWhatItMayMissOfAFunctionOfManyWaves)
{
  const auto found =
      find<2>("x^2+y^2-0.25+1e-3*sin(20000*x)*sin(20000*y)+if(sin(1e6*x*y)>2, 1, 0)", {3, 6, 14});
  EXPECT_EQ(found.blind_size, 0.);
  const auto noisy = find<2>("1+sin(30000*x*y)*cos(40000*x)-1.9999*if(abs(x)+abs(y)<0.9, 1, 0)", {3, 6, 20});
  EXPECT_GT(noisy.blind_size, 2. / (1 << 20));
  EXPECT_LT(noisy.blind_size, 2e-3);
}

TEST(ParallelMembraneSearch, TellsJumpsAndPolesFromSteepFunctions)
{
  const auto largest_remainder = [](const std::string &text)
  {
    double largest = 0.;
    for (const auto &root : find<2>(text, {3, 5, 6}).roots)
      largest = std::max(largest, std::abs(root.remainder) / root.largest_value);
    return largest;
  };
  EXPECT_LT(largest_remainder("tanh(1e6*(x^2+2*y^2-0.25))"), 1e-3);
  EXPECT_LT(largest_remainder("(x^2+2*y^2-0.25)^3"), 1e-12);
  EXPECT_GT(largest_remainder("if(x^2+y^2<0.2, -1, 1)"), 0.9);
  EXPECT_GT(largest_remainder("1/(x^2+y^2-0.2001)"), 0.9);
}

TEST(ParallelZeroSetDistance, DependsOnTheSignOfTheFunctionAlone)
{
  const auto f = make_function<2>("x^2+2*y^2-0.25", 1, "f", false);
  const auto points = known_points(find<2>("x^2+2*y^2-0.25", {3, 5, 6}));
  const ZeroSetDistance<2> distance(*f, points);
  for (const std::string text :
       {"1e-9*(x^2+2*y^2-0.25)", "exp(20*(x^2+2*y^2-0.25))-1", "(x^2+2*y^2-0.25)^3",
        "tanh(100*(x^2+2*y^2-0.25))", "1e12*(x^2+2*y^2-0.25)", "sqrt(x^2+2*y^2)-0.5"})
  {
    const auto g = make_function<2>(text, 1, "g", false);
    const ZeroSetDistance<2> other(*g, points);
    for (const Point<2> &p : {Point<2>(0.51, 0.02), Point<2>(0.1, 0.36), Point<2>(-0.33, -0.22),
                              Point<2>(0.9, 0.9), Point<2>(0.1, 0.1)})
      EXPECT_NEAR(other.value(p), distance.value(p), 2e-7) << text << " at " << p;
  }
}

TEST(ParallelZeroSetDistance, IsTheDistanceFromACircle)
{
  const auto f = make_function<2>("(x-0.1)^2+y^2-0.16", 1, "f", false);
  const ZeroSetDistance<2> distance(*f, known_points(find<2>("(x-0.1)^2+y^2-0.16", {3, 5, 6})));
  for (const Point<2> &p : {Point<2>(0.52, 0.03), Point<2>(0.1, 0.37), Point<2>(-0.25, -0.2)})
    EXPECT_NEAR(distance.value(p), p.distance(Point<2>(0.1, 0.)) - 0.4, 1e-6);
  // From the nearest known point, and those are a cell apart.
  for (const Point<2> &p : {Point<2>(0.9, 0.9), Point<2>(0.12, 0.01)})
    EXPECT_NEAR(distance.value(p), p.distance(Point<2>(0.1, 0.)) - 0.4, 0.01);
  Tensor<1, 2> outwards;
  outwards[0] = 1.;
  EXPECT_NEAR(distance.offset(Point<2>(0.499, 0.), outwards, 0.01), 0.001, 1e-12);
  EXPECT_NEAR(distance.offset(Point<2>(0.501, 0.), outwards, 0.01), -0.001, 1e-12);
  EXPECT_EQ(distance.offset(Point<2>(0.6, 0.), outwards, 0.01), 0.);
}
