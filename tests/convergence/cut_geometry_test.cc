// SPDX-License-Identifier: LGPL-2.1-or-later
// doc/verification.md, section 1: lengths, areas and normals from the cut-cell rules.
#include <gemmule/geometry/cut_geometry.h>

#include <deal.II/base/function_signed_distance.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>

#include <cmath>
#include <gtest/gtest.h>

#include "support/level_set_mesh.h"

namespace Gemmule
{
using namespace dealii;
using Testing::LevelSetMesh;

namespace
{
  struct GeometryErrors
  {
    double measure, volume, normal;
  };

  template <int dim>
  GeometryErrors circle_errors(const LevelSetMesh<dim> &mesh, const Point<dim> &center, const double radius)
  {
    CutGeometry<dim> geometry;
    geometry.reinit(mesh.dof_handler, mesh.level_set);
    const double pi = numbers::PI;
    const double measure = dim == 2 ? 2. * pi * radius : 4. * pi * radius * radius;
    const double volume = dim == 2 ? pi * radius * radius : 4. / 3. * pi * std::pow(radius, 3);
    double normal_error = 0.;
    for (const auto &cell : geometry.cut_cells())
      for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
      {
        const auto r = cell.physical(cell.surface_points[q]) - center;
        normal_error = std::max(normal_error, (cell.normals[q] - r / r.norm()).norm());
      }
    return {std::abs(geometry.measure() - measure) / measure,
            std::abs(geometry.enclosed_volume() - volume) / volume,
            Utilities::MPI::max(normal_error, MPI_COMM_WORLD)};
  }
} // namespace

TEST(ParallelCutGeometry, CircleConvergesAtTheOrderOfTheCubicLevelSet)
{
  const Point<2> center(0.013, -0.027);
  const double radius = 0.45;
  GeometryErrors coarse{}, fine{};
  for (const unsigned int level : {4, 6})
  {
    LevelSetMesh<2> mesh(level);
    mesh.interpolate(Functions::SignedDistance::Sphere<2>(center, radius));
    coarse = fine;
    fine = circle_errors(mesh, center, radius);
  }
  EXPECT_LT(fine.measure, 1e-9);
  EXPECT_LT(fine.volume, 1e-9);
  // two refinements: order p multiplies the error by 4^-p
  EXPECT_LT(fine.measure, coarse.measure * std::pow(4., -3.8));
  EXPECT_LT(fine.volume, coarse.volume * std::pow(4., -3.8));
  EXPECT_LT(fine.normal, coarse.normal * std::pow(4., -2.8));
}

TEST(ParallelCutGeometry, HangingNodesOnCutCellsKeepTheAccuracy)
{
  const Point<2> center(0.013, -0.027);
  LevelSetMesh<2> mesh(5);
  mesh.refine_where([](const Point<2> &p) { return p[0] > 0.1; });
  mesh.interpolate(Functions::SignedDistance::Sphere<2>(center, 0.45));
  const auto errors = circle_errors(mesh, center, 0.45);
  EXPECT_LT(errors.measure, 1e-7);
  EXPECT_LT(errors.volume, 1e-7);
}

TEST(ParallelCutGeometry, CutsThroughVerticesAlongEdgesAndSlivers)
{
  // h = 1/8: the circle passes through vertices and touches grid lines at its four extreme points; shifts
  // down to 1e-10 h make slivers of every size.
  for (const double shift : {0., 1e-3, 1e-6, 1e-9, 1e-10, -1e-10, -1e-7})
  {
    LevelSetMesh<2> mesh(4);
    const Point<2> center(shift / 8., -shift / 8.);
    mesh.interpolate(Functions::SignedDistance::Sphere<2>(center, 0.5));
    const auto errors = circle_errors(mesh, center, 0.5);
    EXPECT_LT(errors.measure, 2e-5) << "shift " << shift << " h";
    EXPECT_LT(errors.volume, 2e-5) << "shift " << shift << " h";
  }
}

TEST(CutGeometry, SphereInThreeDimensions)
{
  LevelSetMesh<3> mesh(3);
  const Point<3> center(0.01, 0.02, -0.03);
  mesh.interpolate(Functions::SignedDistance::Sphere<3>(center, 0.6));
  const auto errors = circle_errors(mesh, center, 0.6);
  EXPECT_LT(errors.measure, 1e-3);
  EXPECT_LT(errors.volume, 1e-3);
}
} // namespace Gemmule
