// SPDX-License-Identifier: LGPL-2.1-or-later
// Which side of a membrane a point is on: by the level set within the band and at its edge, by the winding
// number where that is too near to the membrane.
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/geometry/narrow_band_level_set.h>

#include <deal.II/base/function_signed_distance.h>

#include <gtest/gtest.h>

#include "support/level_set_mesh.h"

using namespace Gemmule;
using namespace dealii;
using Gemmule::Testing::LevelSetMesh;

namespace
{
/** On a lattice of points that keeps clear of the circle or sphere. */
template <int dim>
void expect_the_right_sides(const unsigned int level)
{
  const double radius = 0.6;
  Point<dim> center;
  for (unsigned int d = 0; d < dim; ++d)
    center[d] = 0.03 * (d + 1);
  LevelSetMesh<dim> mesh(level);
  mesh.interpolate(Functions::SignedDistance::Sphere<dim>(center, radius));
  CutGeometry<dim> geometry;
  geometry.reinit(mesh.dof_handler, mesh.level_set);
  const auto cloud = gather_cloud(bare_cloud(geometry), MPI_COMM_WORLD);
  const std::vector<LevelSetCell<dim>> no_cells;
  Point<dim> corner;
  for (unsigned int d = 0; d < dim; ++d)
    corner[d] = -1.;
  const NarrowBandLevelSet<dim> with_cloud(no_cells, corner, &cloud), without(no_cells, corner);

  const unsigned int n = 10;
  unsigned int n_inside = 0;
  for (unsigned int i = 0; i < std::pow(n, dim); ++i)
  {
    Point<dim> x;
    for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n)
      x[d] = -0.95 + 1.9 * (rest % n) / (n - 1.);
    const double distance = x.distance(center) - radius;
    if (std::abs(distance) < 2. / (1 << level))
      continue;
    n_inside += distance < 0.;
    for (const double wrong_or_right : {-1., 1.})
    {
      EXPECT_DOUBLE_EQ(with_cloud.with_side(wrong_or_right * distance, x), distance) << x;
      EXPECT_DOUBLE_EQ(without.with_side(wrong_or_right * distance, x), wrong_or_right * distance);
    }
  }
  EXPECT_GT(n_inside, 10u);
}
} // namespace

TEST(ParallelNarrowBandLevelSet, WindingNumberTellsTheSide)
{
  expect_the_right_sides<2>(4);
  expect_the_right_sides<3>(3);
}

TEST(NarrowBandLevelSet, WithinTheBandTheLevelSetTellsTheSide)
{
  // One cell with phi = x - 0.25, and points that would say the opposite.
  std::vector<LevelSetCell<2>> cells(1);
  cells[0].size = 1.;
  for (unsigned int i = 0; i < TensorLagrange<2, 3>::n; ++i)
    cells[0].level_set[i] = TensorLagrange<2, 3>::node(i)[0] - 0.25;
  MembraneCloud<2> cloud;
  cloud.points = {Point<2>(0.25, 0.5)};
  cloud.normals = {Point<2>(-1., 0.)};
  cloud.weights = {100.};
  const NarrowBandLevelSet<2> band(cells, Point<2>(), &cloud);
  EXPECT_EQ(band.with_side(0.15, Point<2>(0.1, 0.5)), -0.15);
  EXPECT_EQ(band.with_side(-0.35, Point<2>(0.6, 0.5)), 0.35);
  ASSERT_TRUE(band.value(Point<2>(0.6, 0.5)));
  EXPECT_NEAR(*band.value(Point<2>(0.6, 0.5)), 0.35, 1e-14);
  EXPECT_FALSE(band.value(Point<2>(1.6, 0.5)));
}

namespace
{
/**
 * Two cells beside each other with phi = x - 0.25, another one of half the size on the right of them, and a
 * point of a membrane that says the opposite wherever it is asked.
 */
struct WrongCloud
{
  WrongCloud()
  {
    add_cell(Point<2>(0., 0.), 1.);
    add_cell(Point<2>(1., 0.), 1.);
    add_cell(Point<2>(2., 0.), 0.5);
    cloud.points = {Point<2>(0.25, 0.5)};
    cloud.normals = {Point<2>(-1., 0.)};
    cloud.weights = {100.};
  }
  void add_cell(const Point<2> &corner, const double size)
  {
    LevelSetCell<2> cell;
    cell.corner = corner;
    cell.size = size;
    for (unsigned int i = 0; i < TensorLagrange<2, 3>::n; ++i)
      cell.level_set[i] = corner[0] + size * TensorLagrange<2, 3>::node(i)[0] - 0.25;
    cells.push_back(cell);
  }
  /** What tells the side of a point. */
  std::string side_is_from(const Point<2> &x) const
  {
    const NarrowBandLevelSet<2> band(cells, Point<2>(), &cloud);
    const double side = band.with_side(1., x);
    EXPECT_EQ(band.with_side(-1., x), side);
    return (side > 0.) == (x[0] > 0.25) ? "level set" : "cloud";
  }

  std::vector<LevelSetCell<2>> cells;
  MembraneCloud<2> cloud;
};
} // namespace

// Nodes lie there, and the points of the membrane would be summed over for each of them.
TEST(NarrowBandLevelSet, TheBandIncludesItsUpperFaces)
{
  const WrongCloud wrong;
  const NarrowBandLevelSet<2> band(wrong.cells, Point<2>(), &wrong.cloud);
  for (const auto &x : {Point<2>(0.1, 1.), Point<2>(1., 1.), Point<2>(2., 0.75), Point<2>(2., 1.),
                        Point<2>(2.5, 0.25), Point<2>(2.5, 0.5), Point<2>(2.25, 0.5)})
  {
    ASSERT_TRUE(band.value(x)) << x;
    EXPECT_NEAR(*band.value(x), x[0] - 0.25, 1e-14) << x;
    EXPECT_EQ(wrong.side_is_from(x), "level set") << x;
  }
  for (const auto &x : {Point<2>(2.001, 0.75), Point<2>(0.5, 1.001), Point<2>(2.501, 0.5)})
    EXPECT_FALSE(band.value(x)) << x;
}

// A node of the band comes from beside it when the membrane moves, those of a new mesh from everywhere.
TEST(NarrowBandLevelSet, OutsideOfTheBandItsEdgeTellsTheSide)
{
  const WrongCloud wrong;
  for (const auto &x : {Point<2>(1., 1.01), Point<2>(1., 1.49), Point<2>(1.5, -0.4), Point<2>(2.6, 0.6),
                        Point<2>(2.9, 0.25), Point<2>(2.2, 0.7), Point<2>(-0.2, 0.5), Point<2>(-0.1, -0.1),
                        Point<2>(1., 1.51), Point<2>(3.1, 0.25), Point<2>(1000., -300.), Point<2>(1., -50.)})
    EXPECT_EQ(wrong.side_is_from(x), "level set") << x;
  // Where the edge is as near to the membrane as the point to it, and nearer than half a cell.
  for (const auto &x : {Point<2>(-0.6, 0.5), Point<2>(-70., 0.5), Point<2>(0.2, 1.1), Point<2>(0.3, 1.2),
                        Point<2>(0.3, -0.1), Point<2>(0.7, 1.5)})
    EXPECT_EQ(wrong.side_is_from(x), "cloud") << x;
}

namespace
{
/** The band around a circle or sphere, as wide as that of a run: its edge and the winding number agree. */
template <int dim>
void expect_the_same_sides_beside_the_band(const unsigned int level)
{
  const double radius = 0.55;
  const Functions::SignedDistance::Sphere<dim> sphere(Point<dim>(), radius);
  LevelSetMesh<dim> mesh(level);
  mesh.interpolate(sphere);
  CutGeometry<dim> geometry;
  geometry.reinit(mesh.dof_handler, mesh.level_set);
  const auto cloud = gather_cloud(bare_cloud(geometry), MPI_COMM_WORLD);
  std::vector<LevelSetCell<dim>> cells;
  const double h = 2. / (1 << level);
  Point<dim> corner;
  for (unsigned int d = 0; d < dim; ++d)
    corner[d] = -1.;
  const CubeLattice<dim> lattice{corner, h};
  for (unsigned int i = 0; i < std::pow(1 << level, dim); ++i)
  {
    LatticeKey<dim> key;
    for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= 1 << level)
      key[d] = rest % (1 << level);
    LevelSetCell<dim> cell;
    cell.corner = lattice.corner(key);
    cell.size = h;
    for (unsigned int k = 0; k < TensorLagrange<dim, 3>::n; ++k)
      cell.level_set[k] = sphere.value(cell.corner + h * Tensor<1, dim>(TensorLagrange<dim, 3>::node(k)));
    if (std::abs(sphere.value(
            cell.corner +
            0.5 * h * Tensor<1, dim>(TensorLagrange<dim, 3>::node(TensorLagrange<dim, 3>::n - 1)))) < 2.5 * h)
      cells.push_back(cell);
  }
  const std::vector<LevelSetCell<dim>> no_cells;
  const NarrowBandLevelSet<dim> with_band(cells, corner, &cloud), without_band(no_cells, corner, &cloud);
  unsigned int n_beside = 0;
  const unsigned int n = dim == 2 ? 23 : 11;
  for (unsigned int i = 0; i < std::pow(n, dim); ++i)
  {
    Point<dim> x;
    for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n)
      x[d] = -0.97 + 1.94 * (rest % n) / (n - 1.);
    n_beside += !with_band.value(x);
    if (std::abs(sphere.value(x)) > h)
    {
      EXPECT_EQ(with_band.with_side(1., x), without_band.with_side(1., x)) << x;
    }
  }
  EXPECT_GT(n_beside, 20u);
}
} // namespace

TEST(ParallelNarrowBandLevelSet, TheEdgeOfTheBandAndTheWindingNumberAgree)
{
  expect_the_same_sides_beside_the_band<2>(4);
  expect_the_same_sides_beside_the_band<3>(4);
}
