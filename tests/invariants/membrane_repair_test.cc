// SPDX-License-Identifier: LGPL-2.1-or-later
// What is smaller than a cell is removed from a membrane, with changes of its topology; area and masses stay.
#include <gemmule/geometry/membrane_repair.h>
#include <gemmule/geometry/membrane_transport.h>

#include <deal.II/base/function_signed_distance.h>

#include <cmath>
#include <gtest/gtest.h>

#include "support/coupled_run.h"
#include "support/level_set_mesh.h"

using namespace Gemmule;
using namespace Gemmule::Testing;
using namespace dealii;

namespace
{
/** Largest distance from the circle of radius 0.45 of what a repair with 0.75 cells leaves of it. */
double error_on_a_circle(const unsigned int level)
{
  const double radius = 0.45, h = 2. / (1 << level);
  LevelSetMesh<2> mesh(level);
  Interface<2> interface(mesh.triangulation);
  interface.reinit_mesh();
  interface.interpolate(ScalarFunctionFromFunctionObject<2>(
      [=](const Point<2> &x) { return x.distance(Point<2>(0.03, 0.01)) - radius; }));
  interface.cut();
  const CutGeometry<2> &geometry = interface.geometry();
  MembraneSnapshot<2> membrane;
  membrane.origin = Point<2>(-1., -1.);
  membrane.patches = gather_bare_patches(geometry, MPI_COMM_WORLD);
  interface.set_distance(MembraneProjection<2>(membrane.patches, membrane.origin));
  membrane.narrow_band = interface.level_set().gather_narrow_band();
  membrane.cloud = gather_cloud(bare_cloud(geometry), MPI_COMM_WORLD);
  EXPECT_EQ(largest_unresolved_cell(MembraneProjection<2>(membrane.patches, membrane.origin), 1.), 0.);

  const double arclength = remove_small_features(membrane, 0.75 * h, interface, MPI_COMM_WORLD);
  EXPECT_NEAR(arclength, 2. * numbers::PI * radius, 1e-3);
  double error = 0.;
  for (const auto &cell : geometry.cut_cells())
    for (const auto &point : cell.surface_points)
      error = std::max(error, std::abs(cell.physical(point).distance(Point<2>(0.03, 0.01)) - radius));
  return Utilities::MPI::max(error, MPI_COMM_WORLD);
}

/** Repairs a shape that has two sheets in cells of the finest level 6, and goes on from there. */
void expect_repair(const std::string &shape, const unsigned int components_before,
                   const unsigned int components_after)
{
  AllParameters parameters = small_case();
  parameters.membrane.level_set = shape;
  parameters.membrane.initial_concentration = "0.5+0.3*sin(4*x+3*y)";
  parameters.membrane.initial_total_concentration = "1+0.2*cos(2*x)*(1+y)";
  parameters.membrane.cahn_number = 0.08;
  parameters.mesh.finest_level = 6;
  parameters.arclength.model = Parameters::ArclengthModel::penalty;
  parameters.arclength.penalty = 10.;
  CoupledSystem<2> system(parameters, MPI_COMM_WORLD);
  system.initialise();
  const StatisticsRow before = statistics_of(system);
  ASSERT_EQ(before.components, components_before);
  EXPECT_FALSE(system.membrane_is_resolved());

  const RepairReport report = system.repair_membrane();
  const StatisticsRow after = statistics_of(system);
  EXPECT_EQ(after.components, components_after);
  EXPECT_TRUE(system.membrane_is_resolved());
  EXPECT_DOUBLE_EQ(after.time, before.time);
  EXPECT_NEAR(report.arclength_before, before.arclength, 0.02 * before.arclength);
  EXPECT_NEAR(report.arclength_after, after.arclength, 1e-12);
  EXPECT_LT(after.arclength, before.arclength);
  EXPECT_NEAR(system.reference_arclength() / before.arclength,
              report.arclength_after / report.arclength_before, 1e-12);
  // The mass of what has gone is found again on the rest.
  EXPECT_LT(after.f_total_max, 1.3 * before.f_total_max);
  EXPECT_GT(after.f_total_min, 0.8 * before.f_total_min);
  EXPECT_GT(after.composition_min, before.composition_min - 0.05);
  EXPECT_LT(after.composition_max, before.composition_max + 0.05);

  auto rows = run_steps(system, 10, 1e-3);
  rows.insert(rows.begin(), before);
  for (const auto figure : {&StatisticsRow::mass_f, &StatisticsRow::mass_total, &StatisticsRow::area})
    EXPECT_LT(largest_drift(rows, figure), 3e-12);
  EXPECT_EQ(rows.back().components, components_after);
  for (unsigned int i = 2; i < rows.size(); ++i)
    EXPECT_LT(rows[i].energy_total, rows[i - 1].energy_total);
}
} // namespace

TEST(ParallelMembraneRepair, LeavesWhatIsResolved)
{
  const double coarse = error_on_a_circle(4), fine = error_on_a_circle(5);
  EXPECT_LT(fine, 1e-4);
  EXPECT_GT(std::log2(coarse / fine), 3.);
}

TEST(ParallelMembraneRepair, MassesStayWhereTheRepairedPlaceIsDilute)
{
  // The concentration is 1e-4 around the point that has been repaired, and one on the other side.
  LevelSetMesh<2> mesh(7);
  const Point<2> center(0.03, 0.01);
  mesh.interpolate(Functions::SignedDistance::Sphere<2>(center, 0.45));
  CutGeometry<2> geometry;
  geometry.reinit(mesh.dof_handler, mesh.level_set);
  const auto f = [&](const Point<2> &p) { return 1e-4 + 0.5 * (1. - std::tanh((p[0] - center[0]) / 0.05)); };
  auto patches = gather_bare_patches(geometry, MPI_COMM_WORLD);
  for (auto &patch : patches)
    for (unsigned int i = 0; i < MembraneFields<2>::n; ++i)
      patch.fields.concentration[i] =
          f(patch.corner + patch.size * Tensor<1, 2>(TensorLagrange<2, 3>::node(i)));
  const MembraneProjection<2> membrane(patches, Point<2>(-1., -1.));
  const auto mass_of = [&](const Function<2> &concentration)
  {
    double mass = 0.;
    for (const auto &cell : geometry.cut_cells())
      for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
        mass += cell.surface_weights[q] * concentration.value(cell.physical(cell.surface_points[q]));
    return Utilities::MPI::sum(mass, MPI_COMM_WORLD);
  };
  const Point<2> repaired(center[0] + 0.45, center[1]), opposite(center[0] - 0.45, center[1]);
  const double carried = mass_of(ScalarFunctionFromFunctionObject<2>(f));
  for (const double missing : {0., 2e-6, -2e-6})
  {
    const std::vector<Point<2>> points{repaired};
    const RepairedConcentration<2> concentration(membrane, &MembraneFields<2>::concentration,
                                                 carried + missing, geometry, points, MPI_COMM_WORLD);
    EXPECT_NEAR(mass_of(concentration), carried + missing, 1e-12);
    EXPECT_NEAR(concentration.value(opposite), f(opposite), 1e-6);
    EXPECT_NEAR(concentration.value(repaired) / f(repaired), 1. + missing / 2.2e-5, 0.05);
  }
}

TEST(ParallelMembraneRepair, MergesTwoVesiclesAcrossAFilmWithinACell)
{
  // A film of 0.6 cells in the middle of a column of cells.
  expect_repair("min((x-0.015625-0.259375)^2+y^2, (x-0.015625+0.259375)^2+y^2)-0.0625", 2, 1);
}

TEST(ParallelMembraneRepair, CutsAThreadWithinACell)
{
  // Cassini's oval with a neck of 0.6 cells, in the middle of a row of cells.
  expect_repair("((x-0.01)^2+(y-0.015625)^2)^2-0.245*((x-0.01)^2-(y-0.015625)^2)-2.154e-5", 1, 2);
}
