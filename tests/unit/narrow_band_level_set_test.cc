// SPDX-License-Identifier: LGPL-2.1-or-later
// Which side of a membrane a point is on: by the level set within the band, by the winding number beyond it.
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

// Nodes lie there, and the points of the membrane would be summed over for each of them.
TEST(NarrowBandLevelSet, TheBandIncludesItsUpperFaces)
{
  // Two cells beside each other with phi = x - 0.25, and points that would say the opposite.
  std::vector<LevelSetCell<2>> cells(2);
  for (unsigned int c = 0; c < 2; ++c)
  {
    cells[c].corner = Point<2>(c, 0.);
    cells[c].size = 1.;
    for (unsigned int i = 0; i < TensorLagrange<2, 3>::n; ++i)
      cells[c].level_set[i] = c + TensorLagrange<2, 3>::node(i)[0] - 0.25;
  }
  MembraneCloud<2> cloud;
  cloud.points = {Point<2>(0.25, 0.5)};
  cloud.normals = {Point<2>(-1., 0.)};
  cloud.weights = {100.};
  const NarrowBandLevelSet<2> band(cells, Point<2>(), &cloud);
  for (const auto &x :
       {Point<2>(0.1, 1.), Point<2>(1., 1.), Point<2>(2., 0.5), Point<2>(2., 1.), Point<2>(2., 0.)})
  {
    ASSERT_TRUE(band.value(x)) << x;
    EXPECT_NEAR(*band.value(x), x[0] - 0.25, 1e-14) << x;
    EXPECT_EQ(band.with_side(-1., x), std::copysign(1., x[0] - 0.25)) << x;
  }
  EXPECT_FALSE(band.value(Point<2>(2.001, 0.5)));
  EXPECT_FALSE(band.value(Point<2>(0.5, 1.001)));
}
