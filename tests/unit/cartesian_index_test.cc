// SPDX-License-Identifier: LGPL-2.1-or-later
// Cells and points that are found by their integer coordinates, compared with a search through all of them.
#include <gemmule/base/cartesian_index.h>

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <set>

using namespace Gemmule;
using namespace dealii;

namespace
{
template <int dim>
struct Cell
{
  Point<dim> corner;
  double size;
};

/** A corner that is no binary fraction. */
template <int dim>
Point<dim> box_corner()
{
  Point<dim> corner;
  for (unsigned int d = 0; d < dim; ++d)
    corner[d] = -0.7 - 0.1 * d;
  return corner;
}

/** Cells of a box of edge 1.2 at box_corner(), divided at random down to level four; @p part of them. */
template <int dim>
std::vector<Cell<dim>> random_cells(std::mt19937 &generator, const double part)
{
  std::uniform_real_distribution<double> uniform(0., 1.);
  std::vector<std::pair<LatticeKey<dim>, unsigned int>> to_divide{{LatticeKey<dim>{}, 0}};
  std::vector<Cell<dim>> cells;
  while (!to_divide.empty())
  {
    const auto [key, level] = to_divide.back();
    to_divide.pop_back();
    const CubeLattice<dim> lattice{box_corner<dim>(), std::ldexp(1.2, -static_cast<int>(level))};
    if (level < 2 || (level < 4 && uniform(generator) < 0.5))
      for (unsigned int child = 0; child < (1u << dim); ++child)
        to_divide.push_back({child_position<dim>(key, child), level + 1});
    else if (uniform(generator) < part)
      cells.push_back({lattice.corner(key), lattice.size});
  }
  return cells;
}

/** Is @p x in the closed cell, or not farther from it than @p margin? */
template <int dim>
bool holds(const Cell<dim> &cell, const Point<dim> &x, const double margin)
{
  for (unsigned int d = 0; d < dim; ++d)
    if (x[d] < cell.corner[d] - margin || x[d] > cell.corner[d] + cell.size + margin)
      return false;
  return true;
}

template <int dim>
CartesianCellMap<dim> map_of(const std::vector<Cell<dim>> &cells)
{
  CartesianCellMap<dim> map(box_corner<dim>());
  for (unsigned int c = 0; c < cells.size(); ++c)
    map.insert(cells[c].corner, cells[c].size, c);
  return map;
}

/** In and around the box; many on faces, edges and corners of cells. */
template <int dim>
std::vector<Point<dim>> points_in_and_around_cells(std::mt19937 &generator)
{
  std::uniform_real_distribution<double> uniform(-0.1, 1.3);
  std::uniform_int_distribution<int> position(-2, 18), kind(0, 2);
  std::vector<Point<dim>> points;
  for (unsigned int i = 0; i < 3000; ++i)
  {
    Point<dim> x = box_corner<dim>();
    for (unsigned int d = 0; d < dim; ++d)
      switch (kind(generator))
      {
      case 0:
        x[d] += uniform(generator);
        break;
      case 1: // a face, whatever the round-off
        x[d] += position(generator) * (1.2 / 16.);
        break;
      default: // beside it
        x[d] += position(generator) * (1.2 / 16.) + 1e-13 * (uniform(generator) - 0.6);
      }
    points.push_back(x);
  }
  return points;
}

template <int dim>
void expect_cells_are_found()
{
  std::mt19937 generator(7);
  unsigned int n_on_upper_faces = 0;
  for (const double part : {1., 0.5, 0.1})
  {
    const auto cells = random_cells<dim>(generator, part);
    ASSERT_GT(cells.size(), 1u);
    const auto map = map_of(cells);
    for (const Point<dim> &x : points_in_and_around_cells<dim>(generator))
    {
      const int found = map.find(x), half_open = map.find_half_open(x);
      const bool is_in_one =
          std::any_of(cells.begin(), cells.end(), [&](const auto &cell) { return holds(cell, x, 1e-13); });
      EXPECT_TRUE(found >= 0 ? holds(cells[found], x, 1e-9) : !is_in_one) << x;
      EXPECT_TRUE(half_open < 0 || found == half_open) << x;
      n_on_upper_faces += found >= 0 && half_open < 0;
    }
  }
  EXPECT_GT(n_on_upper_faces, 100u);
}
} // namespace

TEST(CartesianCellMap, FindsTheClosedCellsThatHoldAPoint)
{
  expect_cells_are_found<2>();
  expect_cells_are_found<3>();
}

TEST(CartesianCellMap, APointOnAFaceBelongsToTheCellWithTheLargerCoordinatesIfThereIsOne)
{
  CartesianCellMap<2> map;
  map.insert(Point<2>(0., 0.), 1., 10);
  map.insert(Point<2>(1., 0.), 1., 11);
  map.insert(Point<2>(0., 1.), 0.5, 12);
  EXPECT_EQ(map.find(Point<2>(1., 0.5)), 11);
  EXPECT_EQ(map.find(Point<2>(0.25, 1.)), 12);
  // There is none beyond these.
  EXPECT_EQ(map.find(Point<2>(0.75, 1.)), 10);
  EXPECT_EQ(map.find(Point<2>(2., 0.5)), 11);
  EXPECT_EQ(map.find(Point<2>(2., 1.)), 11);
  EXPECT_EQ(map.find(Point<2>(0.5, 1.25)), 12);
  EXPECT_EQ(map.find(Point<2>(0.5, 1.5)), 12);
}

TEST(CartesianCellMap, APointBesideTheCellsBelongsToNone)
{
  CartesianCellMap<2> map;
  map.insert(Point<2>(0., 0.), 1., 1);
  for (const auto &x : {Point<2>(1. + 1e-6, 0.5), Point<2>(-1e-6, 0.5), Point<2>(1.5, 1.), Point<2>(1., 1.5),
                        Point<2>(0.5, 2.), Point<2>(-1., -1.)})
    EXPECT_EQ(map.find(x), -1) << x;
}

TEST(CartesianCellMap, RoundOffOnEitherSideOfAFaceDoesNotMatter)
{
  CartesianCellMap<2> map(Point<2>(-0.3, 0.1));
  map.insert(Point<2>(0.4, 0.8), 0.7, 1);
  for (const double x : {0.4, 1.1})
    for (const double y : {0.8, 1.5})
      for (const double offset : {-1e-14, 0., 1e-14})
        EXPECT_EQ(map.find(Point<2>(x + offset, y - offset)), 1) << x << " " << y << " " << offset;
}

TEST(CartesianCellMap, InHalfOpenCellsEachPointHasOneCellAtMost)
{
  // One cell in each of two maps, as parts of a mesh on two ranks.
  CartesianCellMap<2> left, right;
  left.insert(Point<2>(0., 0.), 1., 1);
  right.insert(Point<2>(1., 0.), 1., 2);
  EXPECT_EQ(left.find_half_open(Point<2>(1., 0.5)), -1);
  EXPECT_EQ(right.find_half_open(Point<2>(1., 0.5)), 2);
  EXPECT_EQ(right.find_half_open(Point<2>(2., 0.5)), -1);
}

TEST(CartesianCellMap, AnEmptyOneFindsNothing)
{
  EXPECT_EQ(CartesianCellMap<2>().find(Point<2>(0., 0.)), -1);
  EXPECT_EQ(CartesianCellMap<3>().find_half_open(Point<3>()), -1);
}

TEST(CubeLattice, ParentsAndChildrenBelongTogetherOnBothSidesOfTheOrigin)
{
  for (int i = -5; i <= 5; ++i)
    for (unsigned int child = 0; child < 8; ++child)
    {
      const LatticeKey<3> key{{i, 3 - i, 2 * i}};
      EXPECT_EQ(parent_position<3>(child_position<3>(key, child)), key);
    }
  EXPECT_EQ((child_position<2>({{-1, 4}}, 1)), (LatticeKey<2>{{-1, 8}}));
  EXPECT_EQ((child_position<2>({{-1, 4}}, 2)), (LatticeKey<2>{{-2, 9}}));
}

TEST(CubeLattice, HoldsItsCorners)
{
  const CubeLattice<2> lattice{Point<2>(-0.7, 0.2), 0.1};
  for (int i = -20; i < 20; ++i)
  {
    const LatticeKey<2> key{{i, 2 * i + 1}};
    EXPECT_EQ(lattice.position_of_corner(lattice.corner(key)), key);
    EXPECT_EQ(lattice.position_of(lattice.corner(key) + Tensor<1, 2>({0.05, 0.01})), key);
  }
}

TEST(CubeLattice, NeighboursAreVisitedRowByRow)
{
  std::vector<LatticeKey<2>> visited;
  for_each_neighbour<2>({{5, -3}}, 1, [&](const LatticeKey<2> &key) { visited.push_back(key); });
  ASSERT_EQ(visited.size(), 9u);
  EXPECT_EQ(visited[0], (LatticeKey<2>{{4, -4}}));
  EXPECT_EQ(visited[1], (LatticeKey<2>{{5, -4}}));
  EXPECT_EQ(visited[8], (LatticeKey<2>{{6, -2}}));
  unsigned int n = 0;
  for_each_neighbour<3>({{0, 0, 0}}, 2, [&](const LatticeKey<3> &) { ++n; });
  EXPECT_EQ(n, 125u);
}

namespace
{
template <int dim>
void expect_points_nearby_are_visited()
{
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-2., 2.);
  const auto random_point = [&]
  {
    Point<dim> x;
    for (unsigned int d = 0; d < dim; ++d)
      x[d] = uniform(generator);
    return x;
  };
  const double bin_size = 0.3, everything = std::numeric_limits<double>::infinity();
  PointBins<dim> bins(box_corner<dim>(), bin_size);
  std::vector<Point<dim>> points;
  for (unsigned int i = 0; i < 1000; ++i)
  {
    points.push_back(random_point());
    bins.insert(points.back(), i);
  }
  for (unsigned int i = 0; i < 100; ++i)
  {
    const Point<dim> x = random_point();
    std::multiset<unsigned int> nearby, rings;
    bins.visit_nearby(x, [&](const unsigned int j) { nearby.insert(j); });
    for (int ring = 0; ring <= 3; ++ring)
    {
      const auto before = rings.size();
      bins.visit_ring(x, ring, everything, [&](const unsigned int j) { rings.insert(j); });
      for (unsigned int j = 0; j < points.size(); ++j)
        EXPECT_TRUE(x.distance(points[j]) >= ring * bin_size || rings.count(j) == 1) << ring;
      EXPECT_TRUE(ring != 1 || rings == nearby);
      EXPECT_GE(rings.size(), before);
    }
    // Each once, and none from far away.
    for (const unsigned int j : rings)
    {
      EXPECT_EQ(rings.count(j), 1u);
      EXPECT_LT(x.distance(points[j]), 4. * std::sqrt(dim) * bin_size);
    }
    // All within a shorter reach, and none of bins beyond it.
    for (const double reach : {0., 0.1, 0.35, 0.8})
    {
      std::multiset<unsigned int> within;
      for (int ring = 0; ring <= 3; ++ring)
        bins.visit_ring(x, ring, reach * reach, [&](const unsigned int j) { within.insert(j); });
      for (unsigned int j = 0; j < points.size(); ++j)
        EXPECT_TRUE(x.distance(points[j]) > reach || within.count(j) == 1) << reach;
      for (const unsigned int j : within)
        EXPECT_LT(x.distance(points[j]), reach + std::sqrt(dim) * 1.01 * bin_size);
    }
  }
}
} // namespace

TEST(PointBins, VisitAllThatIsNearby)
{
  expect_points_nearby_are_visited<2>();
  expect_points_nearby_are_visited<3>();
}

TEST(PointBins, KeepTheOrderWithinABinAndKnowTheFullestOne)
{
  PointBins<2, std::string> bins(Point<2>(), 1.);
  EXPECT_EQ(bins.largest_bin(), 0u);
  bins.insert(Point<2>(0.9, 0.1), "a");
  bins.insert(Point<2>(0.1, 0.9), "b");
  bins.insert(Point<2>(1.1, 0.9), "c");
  EXPECT_EQ(bins.largest_bin(), 2u);
  std::string visited;
  bins.visit_ring(Point<2>(0.5, 0.5), 0, 0., [&](const std::string &s) { visited += s; });
  EXPECT_EQ(visited, "ab");
  bins.visit_nearby(Point<2>(2.5, 0.5), [&](const std::string &s) { visited += s; });
  EXPECT_EQ(visited, "abc");
}
