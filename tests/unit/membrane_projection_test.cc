// SPDX-License-Identifier: LGPL-2.1-or-later
// The nearest sample of a membrane, compared with a search through all of them.
#include <gemmule/base/cube_lattice.h>
#include <gemmule/geometry/membrane_projection.h>

#include <gtest/gtest.h>
#include <limits>
#include <random>

using namespace Gemmule;
using namespace dealii;

namespace
{
constexpr double round_off = 1e-14;

/** The cells that a circle or sphere cuts, those with x > 0 of half the size. */
template <int dim>
struct PatchesOfSphere
{
  static constexpr double radius = 0.45, h = 1. / 8.;
  Point<dim> center, origin;
  std::vector<MembranePatch<dim>> patches;

  explicit PatchesOfSphere(const Point<dim> &center) : center(center)
  {
    for (unsigned int d = 0; d < dim; ++d)
      origin[d] = -1.;
    for (const double size : {h, 0.5 * h})
    {
      const CubeLattice<dim> lattice{origin, size};
      const int n = static_cast<int>(std::lround(2. / size));
      for (int i = 0; i < (dim == 2 ? n * n : n * n * n); ++i)
      {
        LatticeKey<dim> key;
        for (int d = 0, rest = i; d < dim; ++d, rest /= n)
          key[d] = rest % n;
        const Point<dim> corner = lattice.corner(key);
        if ((corner[0] > -1e-10) == (size < h))
          add_if_cut(corner, size);
      }
    }
  }

  void add_if_cut(const Point<dim> &corner, const double size)
  {
    MembranePatch<dim> patch{};
    patch.corner = corner;
    patch.size = size;
    bool inside = false, outside = false;
    for (unsigned int i = 0; i < TensorLagrange<dim, 3>::n; ++i)
    {
      const double phi =
          center.distance(corner + size * Tensor<1, dim>(TensorLagrange<dim, 3>::node(i))) - radius;
      patch.level_set[i] = phi;
      (phi < 0. ? inside : outside) = true;
    }
    if (inside && outside)
      patches.push_back(patch);
  }
};

/** Distance of @p x from the nearest sample of all, and of the first ones of the patches. */
template <int dim>
std::pair<double, double> least_distances(const MembraneProjection<dim> &membrane, const Point<dim> &x)
{
  double all = std::numeric_limits<double>::max(), first = all;
  int patch = -1;
  for (const auto &sample : membrane.samples())
  {
    const double distance = x.distance(sample.point);
    all = std::min(all, distance);
    if (static_cast<int>(sample.patch) != patch)
      first = std::min(first, distance);
    patch = sample.patch;
  }
  return {all, first};
}

template <int dim>
void expect_the_nearest_sample(const Point<dim> &center)
{
  const PatchesOfSphere<dim> sphere(center);
  const MembraneProjection<dim> membrane(sphere.patches, sphere.origin);
  std::mt19937 generator(5);
  unsigned int n_near = 0, n_far = 0;
  const auto check = [&](const Point<dim> &x)
  {
    const auto [all, first] = least_distances(membrane, x);
    const double found = x.distance(membrane.nearest(x).point);
    if (all < 3. * sphere.h)
    {
      ++n_near;
      EXPECT_DOUBLE_EQ(found, all) << x;
    }
    else
    {
      ++n_far;
      EXPECT_GE(found, all * (1. - round_off)) << x;
      EXPECT_LE(found, first * (1. + round_off)) << x;
    }
    EXPECT_NEAR(found, std::abs(x.distance(center) - sphere.radius), 0.6 * sphere.h) << x;
  };
  for (const double reach : {0.6, 1., 3.})
  {
    std::uniform_real_distribution<double> uniform(-reach, reach);
    for (unsigned int i = 0; i < 300; ++i)
    {
      Point<dim> x;
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = uniform(generator);
      check(x);
      // On faces of bins.
      for (unsigned int d = 0; d < dim; ++d)
        x[d] = sphere.h * std::round(x[d] / sphere.h);
      check(x);
    }
  }
  check(center);
  EXPECT_GT(n_near, 200u);
  EXPECT_GT(n_far, 200u);
}
} // namespace

TEST(MembraneProjection, FindsTheNearestSampleFromEverywhere)
{
  expect_the_nearest_sample(Point<2>(0.013, 0.007));
  expect_the_nearest_sample(Point<3>(0.013, 0.007, -0.021));
}

// All of the membrane is equally far from the middle, and much of it from the nodes on axes and diagonals.
TEST(MembraneProjection, FindsTheNearestSampleOnAMembraneWithTheSymmetryOfTheMesh)
{
  expect_the_nearest_sample(Point<2>());
  expect_the_nearest_sample(Point<3>());
}
