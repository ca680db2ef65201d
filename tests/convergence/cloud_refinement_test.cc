// SPDX-License-Identifier: LGPL-2.1-or-later
// The quadrature points of an earlier membrane on a mesh that has been refined since.
#include <gemmule/coupling/trial_clouds.h>
#include <gemmule/geometry/cloud_refinement.h>
#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/mesh/cell_locator.h>

#include <deal.II/base/function_signed_distance.h>
#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <numeric>

#include "support/level_set_mesh.h"

using namespace dealii;
using namespace Gemmule;
using namespace Gemmule::Testing;

namespace
{
double f(const Point<2> &p)
{
  return 1. + 0.3 * p[0] - 0.2 * p[1] * p[1];
}

MembraneSnapshot<2> circle_snapshot(const CutGeometry<2> &geometry)
{
  using Fields = MembraneFields<2>;
  std::vector<Fields> fields(geometry.cut_cells().size());
  MembraneCloud<2> cloud;
  for (unsigned int c = 0; c < fields.size(); ++c)
  {
    const auto &cell = geometry.cut_cells()[c];
    for (unsigned int i = 0; i < Fields::n; ++i)
    {
      fields[c].concentration[i] = f(cell.physical(TensorLagrange<2, 3>::node(i)));
      fields[c].total_concentration[i] = 2. * fields[c].concentration[i];
    }
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      const Point<2> p = cell.physical(cell.surface_points[q]);
      cloud.points.push_back(p);
      cloud.normals.push_back(cell.normals[q]);
      cloud.weights.push_back(cell.surface_weights[q]);
      cloud.concentration.push_back(f(p));
      cloud.total_concentration.push_back(2. * f(p));
    }
  }
  MembraneSnapshot<2> snapshot;
  snapshot.origin = Point<2>(-1., -1.);
  snapshot.patches = gather_patches(geometry.cut_cells(), fields, MPI_COMM_WORLD);
  snapshot.cloud = gather_cloud(cloud, MPI_COMM_WORLD);
  return snapshot;
}

/** Largest error of the measure and of the mass in a cell of the mesh, relative to its size. */
double largest_error_in_a_cell(const MembraneSnapshot<2> &snapshot, const LevelSetMesh<2> &mesh,
                               const CutGeometry<2> &geometry)
{
  CellLocator<2> locator;
  locator.reinit(mesh.triangulation);
  std::vector<double> measure(mesh.triangulation.n_active_cells(), 0.), mass = measure;
  const auto &cloud = snapshot.cloud;
  for (unsigned int i = 0; i < cloud.points.size(); ++i)
    if (const auto *cell = locator.find(cloud.points[i]))
    {
      measure[cell->active_cell_index] += cloud.weights[i];
      mass[cell->active_cell_index] += cloud.weights[i] * cloud.concentration[i];
    }
  double error = 0.;
  for (const auto &cell : geometry.cut_cells())
  {
    double exact_measure = 0., exact_mass = 0.;
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      exact_measure += cell.surface_weights[q];
      exact_mass += cell.surface_weights[q] * f(cell.physical(cell.surface_points[q]));
    }
    error = std::max({error, std::abs(measure[cell.active_cell_index] - exact_measure) / cell.size,
                      std::abs(mass[cell.active_cell_index] - exact_mass) / cell.size});
  }
  return Utilities::MPI::max(error, MPI_COMM_WORLD);
}

/** Gives the snapshot the points that the mesh needs; whether these are others than it had. */
bool refine(MembraneSnapshot<2> &snapshot, const LevelSetMesh<2> &mesh)
{
  auto cloud = refined_cloud(snapshot, mesh.triangulation);
  if (!cloud)
    return false;
  snapshot.cloud = std::move(*cloud);
  return true;
}

std::array<double, 3> sums(const MembraneCloud<2> &cloud)
{
  std::array<double, 3> s{};
  for (unsigned int i = 0; i < cloud.points.size(); ++i)
  {
    s[0] += cloud.weights[i];
    s[1] += cloud.weights[i] * cloud.concentration[i];
    s[2] += cloud.weights[i] * cloud.total_concentration[i];
  }
  return s;
}
} // namespace

TEST(ParallelCloudRefinement, EveryNewCellHasItsShareAndTheSumsStay)
{
  LevelSetMesh<2> mesh(4);
  const Functions::SignedDistance::Sphere<2> circle(Point<2>(0.0137, 0.0071), 0.45);
  mesh.interpolate(circle);
  CutGeometry<2> geometry;
  geometry.reinit(mesh.dof_handler, mesh.level_set);
  MembraneSnapshot<2> snapshot = circle_snapshot(geometry);
  const auto before = sums(snapshot.cloud);
  EXPECT_FALSE(refined_cloud(snapshot, mesh.triangulation).has_value()) << "nothing has been refined";

  // cells of three levels along the membrane
  mesh.refine_where([](const auto &p) { return p[0] > 0.; });
  mesh.refine_where([](const auto &p) { return p[0] > 0.2; });
  mesh.interpolate(circle);
  geometry.reinit(mesh.dof_handler, mesh.level_set);
  EXPECT_GT(largest_error_in_a_cell(snapshot, mesh, geometry), 0.05) << "this is what it is for";
  EXPECT_TRUE(refine(snapshot, mesh));
  EXPECT_LT(largest_error_in_a_cell(snapshot, mesh, geometry), 1e-3);
  const auto after = sums(snapshot.cloud);
  for (unsigned int i = 0; i < 3; ++i)
    EXPECT_NEAR(after[i] / before[i], 1., 1e-13);

  // Again, and on a coarser mesh, the sums stay what they are: the cells have all the points they need.
  refine(snapshot, mesh);
  for (unsigned int i = 0; i < 3; ++i)
    EXPECT_NEAR(sums(snapshot.cloud)[i] / before[i], 1., 1e-13);
  for (const auto &cell : mesh.triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && cell->level() > 4)
      cell->set_coarsen_flag();
  mesh.triangulation.execute_coarsening_and_refinement();
  mesh.interpolate(circle);
  geometry.reinit(mesh.dof_handler, mesh.level_set);
  refine(snapshot, mesh);
  EXPECT_LT(largest_error_in_a_cell(snapshot, mesh, geometry), 2e-3);
  for (unsigned int i = 0; i < 3; ++i)
    EXPECT_NEAR(sums(snapshot.cloud)[i] / before[i], 1., 1e-13);
}

TEST(ParallelCloudRefinement, ConcentrationsWithoutMassInACellStay)
{
  LevelSetMesh<2> mesh(4);
  mesh.interpolate(Functions::SignedDistance::Sphere<2>(Point<2>(0.0137, 0.0071), 0.45));
  CutGeometry<2> geometry;
  geometry.reinit(mesh.dof_handler, mesh.level_set);
  MembraneSnapshot<2> snapshot = circle_snapshot(geometry);
  const auto is_in_cell = [](const Point<2> &p) { return p[0] > 0.375 && p[1] > 0. && p[1] < 0.125; };
  auto &cloud = snapshot.cloud;
  double measure = 0., moment = 0.;
  for (unsigned int i = 0; i < cloud.points.size(); ++i)
    if (is_in_cell(cloud.points[i]))
    {
      measure += cloud.weights[i];
      moment += cloud.weights[i] * cloud.points[i][1];
    }
  const auto concentration = [&](const Point<2> &p) { return p[1] - moment / measure; };
  for (unsigned int i = 0; i < cloud.points.size(); ++i)
    cloud.concentration[i] = concentration(cloud.points[i]);
  for (auto &patch : snapshot.patches)
    for (unsigned int i = 0; i < MembraneFields<2>::n; ++i)
      patch.fields.concentration[i] =
          concentration(patch.corner + patch.size * Tensor<1, 2>(TensorLagrange<2, 3>::node(i)));
  const double before = sums(cloud)[1];

  mesh.refine_where([](const auto &p) { return p[0] > 0.; });
  EXPECT_TRUE(refine(snapshot, mesh));
  EXPECT_NEAR(sums(cloud)[1], before, 1e-13);
  unsigned int n = 0;
  for (unsigned int i = 0; i < cloud.points.size(); ++i)
    if (is_in_cell(cloud.points[i]))
    {
      ++n;
      EXPECT_NEAR(cloud.concentration[i], concentration(cloud.points[i]), 1e-4);
    }
  EXPECT_GT(n, 4u);
}

TEST(ParallelCloudRefinement, BelongsToATryAndLeavesTheHistory)
{
  LevelSetMesh<2> mesh(4);
  const Functions::SignedDistance::Sphere<2> circle(Point<2>(0.0137, 0.0071), 0.45);
  mesh.interpolate(circle);
  CutGeometry<2> geometry;
  geometry.reinit(mesh.dof_handler, mesh.level_set);
  const MembraneSnapshot<2> snapshot = circle_snapshot(geometry);
  History<2> history;
  history.begin(snapshot, {});
  TrialClouds<2> clouds(history, mesh.triangulation);
  EXPECT_EQ(&clouds.level_n(), &history.level_n().cloud) << "the mesh is that of the level";
  EXPECT_EQ(clouds.level_n_minus_1(), nullptr);

  mesh.refine_where([](const auto &p) { return p[0] > 0.; });
  clouds.reinit_mesh();
  EXPECT_GT(clouds.level_n().points.size(), 1.3 * snapshot.cloud.points.size());
  EXPECT_EQ(history.level_n().cloud.points, snapshot.cloud.points);
  EXPECT_EQ(history.level_n().cloud.weights, snapshot.cloud.weights);

  // Another try, on that mesh from the start, and as the level before.
  history.accept(snapshot, 0.1, {});
  const TrialClouds<2> later(history, mesh.triangulation);
  ASSERT_NE(later.level_n_minus_1(), nullptr);
  EXPECT_EQ(later.level_n_minus_1()->points, clouds.level_n().points);
  EXPECT_EQ(later.level_n_minus_1()->weights, clouds.level_n().weights);
  for (unsigned int i = 0; i < 3; ++i)
    EXPECT_NEAR(sums(later.level_n())[i] / sums(snapshot.cloud)[i], 1., 1e-13);

  // Where the mesh is coarse again the points are those that the level had.
  for (const auto &cell : mesh.triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && cell->level() > 4)
      cell->set_coarsen_flag();
  mesh.triangulation.execute_coarsening_and_refinement();
  clouds.reinit_mesh();
  EXPECT_EQ(&clouds.level_n(), &history.level_n().cloud);
}
