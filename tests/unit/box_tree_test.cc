// SPDX-License-Identifier: LGPL-2.1-or-later
// The nearest of some boxes or points, compared with a search through all of them.
#include <gemmule/base/box_tree.h>

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

using namespace Gemmule;
using namespace dealii;

namespace
{
template <int dim>
using Boxes = std::vector<typename BoxTree<dim>::Box>;

/** Distance of @p x from the points of a box, by parts of its faces. */
template <int dim>
double distance(const typename BoxTree<dim>::Box &box, const Point<dim> &x)
{
  Point<dim> nearest = x;
  for (unsigned int d = 0; d < dim; ++d)
  {
    if (x[d] < box.lower[d])
      nearest[d] = box.lower[d];
    if (x[d] > box.upper[d])
      nearest[d] = box.upper[d];
  }
  return x.distance(nearest);
}

template <int dim>
Point<dim> random_point(std::mt19937 &generator, const double reach)
{
  std::uniform_real_distribution<double> uniform(-reach, reach);
  Point<dim> x;
  for (unsigned int d = 0; d < dim; ++d)
    x[d] = uniform(generator);
  return x;
}

template <int dim>
void expect_the_nearest_is_found(const Boxes<dim> &boxes, std::mt19937 &generator)
{
  const BoxTree<dim> tree(boxes);
  ASSERT_FALSE(tree.empty());
  for (const double reach : {0.5, 1.5, 40.})
    for (unsigned int i = 0; i < 200; ++i)
    {
      const Point<dim> x = random_point<dim>(generator, reach);
      double least = std::numeric_limits<double>::infinity();
      for (const auto &box : boxes)
      {
        least = std::min(least, distance<dim>(box, x));
        EXPECT_NEAR(std::sqrt(box.distance_square(x)), distance<dim>(box, x), 1e-14 * reach);
      }
      EXPECT_NEAR(distance<dim>(boxes[tree.nearest(x)], x), least, 1e-14 * reach) << x;
    }
}

template <int dim>
void expect_the_nearest_is_found()
{
  std::mt19937 generator(3);
  for (const unsigned int n : {1, 2, 17, 1000})
  {
    Boxes<dim> boxes, points;
    for (unsigned int i = 0; i < n; ++i)
    {
      const Point<dim> lower = random_point<dim>(generator, 1.);
      points.push_back({lower, lower});
      Point<dim> upper = lower;
      for (unsigned int d = 0; d < dim; ++d)
        upper[d] += std::abs(random_point<dim>(generator, 0.1)[d]);
      boxes.push_back({lower, upper});
    }
    expect_the_nearest_is_found<dim>(boxes, generator);
    expect_the_nearest_is_found<dim>(points, generator);
  }
}
} // namespace

TEST(BoxTree, FindsTheNearestBoxOrPoint)
{
  expect_the_nearest_is_found<2>();
  expect_the_nearest_is_found<3>();
}

// What is found must not depend on how the tree is built.
TEST(BoxTree, OfSeveralNearestOnesItTakesTheFirst)
{
  Boxes<3> boxes;
  std::vector<Point<3>> centers;
  for (const int k : {3, 1, 0, 2})
    for (int j = 0; j < 4; ++j)
      for (int i = 3; i >= 0; --i)
      {
        boxes.push_back({Point<3>(i, j, k), Point<3>(i + 1., j + 1., k + 1.)});
        centers.push_back(Point<3>(i + 0.5, j + 0.5, k + 0.5));
      }
  const BoxTree<3> tree(boxes);
  Boxes<3> points;
  for (const auto &center : centers)
    points.push_back({center, center});
  const BoxTree<3> tree_of_centers(points);
  for (double x = -1.; x <= 5.; x += 0.5)
    for (double y = -1.; y <= 5.; y += 0.5)
      for (double z = -1.; z <= 5.; z += 0.5)
      {
        const Point<3> p(x, y, z);
        unsigned int first_box = 0, first_center = 0;
        for (unsigned int i = 1; i < boxes.size(); ++i)
        {
          if (distance<3>(boxes[i], p) < distance<3>(boxes[first_box], p))
            first_box = i;
          if (p.distance_square(centers[i]) < p.distance_square(centers[first_center]))
            first_center = i;
        }
        EXPECT_EQ(tree.nearest(p), first_box) << p;
        EXPECT_EQ(tree_of_centers.nearest(p), first_center) << p;
      }
}

TEST(BoxTree, MayBeEmpty)
{
  EXPECT_TRUE(BoxTree<2>().empty());
  BoxTree<3> tree;
  tree = BoxTree<3>({{Point<3>(), Point<3>()}});
  EXPECT_FALSE(tree.empty());
  EXPECT_EQ(tree.nearest(Point<3>(5., 0., 0.)), 0u);
}
