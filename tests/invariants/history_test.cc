// SPDX-License-Identifier: LGPL-2.1-or-later
// The accepted levels belong to the history: what tries do, meshes that they change included, leaves no
// trace.
#include <gemmule/base/exceptions.h>

#include <cstring>
#include <gtest/gtest.h>
#include <numeric>
#include <type_traits>

#include "support/coupled_run.h"

using namespace Gemmule;
using namespace Gemmule::Testing;

namespace
{
template <typename T>
bool are_same(const std::vector<T> &a, const std::vector<T> &b)
{
  // Of doubles throughout, without padding.
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

bool are_same(const MembraneSnapshot<2> &a, const MembraneSnapshot<2> &b)
{
  return a.time == b.time && a.origin == b.origin && are_same(a.patches, b.patches) &&
         are_same(a.narrow_band, b.narrow_band) && are_same(a.cloud.points, b.cloud.points) &&
         are_same(a.cloud.normals, b.cloud.normals) && are_same(a.cloud.weights, b.cloud.weights) &&
         are_same(a.cloud.concentration, b.cloud.concentration) &&
         are_same(a.cloud.total_concentration, b.cloud.total_concentration);
}

void expect_same(const AcceptedLevels<2> &a, const AcceptedLevels<2> &b)
{
  EXPECT_TRUE(are_same(a.level_n, b.level_n));
  EXPECT_TRUE(are_same(a.level_n_minus_1, b.level_n_minus_1));
  EXPECT_EQ(a.step_to_n, b.step_to_n);
  EXPECT_EQ(a.step_to_n_minus_1, b.step_to_n_minus_1);
  EXPECT_EQ(a.limits.capillary, b.limits.capillary);
  EXPECT_EQ(a.limits.displacement, b.limits.displacement);
}

/** A membrane that is stretched, so that its phase boundaries, which have finer cells, move along it: a long
 * try refines cells of the present membrane. */
AllParameters case_with_changing_mesh()
{
  AllParameters parameters = small_case();
  set_two_phases(parameters, "x-0.3");
  parameters.membrane.initial_total_concentration = "1+0.1*y";
  parameters.domain.boundary_velocity = "2*x; -2*y";
  parameters.mesh.membrane_level = 4;
  parameters.mesh.phase_boundary_level = 5;
  parameters.mesh.membrane_layers = 1;
  parameters.mesh.remeshing_interval = 1;
  return parameters;
}

double mass(const MembraneCloud<2> &cloud)
{
  return std::inner_product(cloud.weights.begin(), cloud.weights.end(), cloud.concentration.begin(), 0.);
}
} // namespace

TEST(ParallelCoupledHistory, IsBitwiseTheSameAfterTriesThatChangeTheMesh)
{
  CoupledSystem<2> system(case_with_changing_mesh(), MPI_COMM_WORLD);
  system.initialise();
  run_steps(system, 3, 0.002);
  const AcceptedLevels<2> before = system.state().levels;
  const unsigned int mesh_changes = system.mesh_changes(), cells = system.mesh().n_global_active_cells();

  system.try_step(0.06);
  ASSERT_GT(system.mesh_changes(), mesh_changes) << "the mesh has to change for this test to mean anything";
  ASSERT_NE(system.mesh().n_global_active_cells(), cells);
  History<2> history;
  history.restore(before);
  const TrialClouds<2> clouds(history, system.mesh());
  ASSERT_GT(clouds.level_n().points.size(), before.level_n.cloud.points.size())
      << "the try has to take other points than those of the history";
  expect_same(system.state().levels, before);
  system.try_step(0.01);
  expect_same(system.state().levels, before);
  EXPECT_THROW(system.try_step(2.), SimulationError);
  expect_same(system.state().levels, before);

  system.try_step(0.005);
  system.accept();
  const AcceptedLevels<2> after = system.state().levels;
  EXPECT_TRUE(are_same(after.level_n_minus_1, before.level_n)) << "it has become the one before";
  EXPECT_EQ(after.step_to_n, 0.005);
  EXPECT_EQ(after.step_to_n_minus_1, before.step_to_n);
  EXPECT_NEAR(mass(after.level_n.cloud) / mass(before.level_n.cloud), 1., 1e-12);
}

TEST(CoupledHistory, GoesOnBitwiseTheSameFromASavedStateAfterATryThatChangedTheMesh)
{
  const AllParameters parameters = case_with_changing_mesh();
  CoupledSystem<2> system(parameters, MPI_COMM_WORLD);
  system.initialise();
  run_steps(system, 3, 0.002);
  const unsigned int mesh_changes = system.mesh_changes();
  system.try_step(0.06);
  ASSERT_GT(system.mesh_changes(), mesh_changes);

  CoupledSystem<2> resumed(parameters, MPI_COMM_WORLD);
  resumed.restore(system.state());
  for (const double dt : {0.005, 0.01, 0.008})
  {
    for (CoupledSystem<2> *const run : {&system, &resumed})
    {
      run->try_step(dt);
      run->accept();
    }
    expect_same(resumed.state().levels, system.state().levels);
  }
}
