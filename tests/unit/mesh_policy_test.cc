// SPDX-License-Identifier: LGPL-2.1-or-later
// When the mesh is adapted in the course of a run.
#include <gemmule/base/exceptions.h>
#include <gemmule/coupling/mesh_policy.h>
#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_transport.h>

#include <deal.II/base/function_signed_distance.h>

#include <gtest/gtest.h>
#include <iostream>

#include "support/level_set_mesh.h"

using namespace dealii;
using namespace Gemmule;
using Testing::LevelSetMesh;

namespace
{
const Functions::SignedDistance::Sphere<2> resting_circle(Point<2>(0.013, -0.027), 0.45);

/** A resting_circle with a given velocity on a mesh of level 4 that its membrane wants to have level 5. */
struct CircleOnAdaptedMesh
{
  LevelSetMesh<2> mesh{4};
  Parameters::Mesh parameters;
  const Parameters::Domain domain;
  Parameters::Membrane membrane;
  TimerOutput timer{std::cout, TimerOutput::never, TimerOutput::cpu_times};
  std::vector<MembranePatch<2>> patches;

  explicit CircleOnAdaptedMesh(const unsigned int remeshing_interval)
  {
    parameters.bulk_level = 4;
    parameters.membrane_level = parameters.phase_boundary_level = 5;
    parameters.remeshing_interval = remeshing_interval;
    membrane.tension_model = Parameters::TensionModel::prescribed;
    patches = gather_bare_patches(cut(resting_circle), MPI_COMM_WORLD);
  }

  CutGeometry<2> cut(const Function<2> &distance)
  {
    mesh.interpolate(distance);
    CutGeometry<2> geometry;
    geometry.reinit(mesh.dof_handler, mesh.level_set);
    return geometry;
  }

  MeshPolicy<2> policy() { return MeshPolicy<2>(mesh.triangulation, parameters, domain, membrane, timer); }

  /** Asks for a mesh for the resting_circle, which a step takes to the right by @p distance. */
  bool adapt(MeshPolicy<2> &policy, const double distance)
  {
    for (auto &patch : patches)
      patch.fields.velocity.fill(Tensor<1, 2>({distance, 0.}));
    const MembraneProjection<2> projection(patches, Point<2>(-1., -1.));
    return policy.adapt(MembraneMotion<2>(projection, TimeStep(1.)));
  }
};
} // namespace

TEST(ParallelMeshPolicy, AdaptsWhereTheMembraneIsAndWhereItGoes)
{
  CircleOnAdaptedMesh run(1000);
  MeshPolicy<2> policy = run.policy();
  EXPECT_THROW(policy.check_refined(run.cut(resting_circle)), StepBreakdown) << "no cell is fine enough yet";
  EXPECT_TRUE(run.adapt(policy, 0.));
  EXPECT_NO_THROW(policy.check_refined(run.cut(resting_circle)));
  EXPECT_DOUBLE_EQ(policy.membrane_cell_size(), 1. / 16.);
  EXPECT_FALSE(run.adapt(policy, 0.)) << "nothing has changed since";

  const Functions::SignedDistance::Sphere<2> moved(Point<2>(0.313, -0.027), 0.45);
  EXPECT_THROW(policy.check_refined(run.cut(moved)), StepBreakdown);
  EXPECT_TRUE(run.adapt(policy, 0.3));
  EXPECT_NO_THROW(policy.check_refined(run.cut(moved)));
  EXPECT_NO_THROW(policy.check_refined(run.cut(resting_circle))) << "the step may be rejected";
  EXPECT_EQ(policy.mesh_changes(), 2u);
}

TEST(ParallelMeshPolicy, CoarsensWhenTheRemeshingIntervalIsOver)
{
  CircleOnAdaptedMesh run(3);
  MeshPolicy<2> policy = run.policy();
  ASSERT_TRUE(run.adapt(policy, 0.3));
  const auto cells = run.mesh.triangulation.n_global_active_cells();
  // The mesh has more cells than a membrane at rest needs: a matter for the third try from now.
  EXPECT_FALSE(run.adapt(policy, 0.));
  EXPECT_FALSE(run.adapt(policy, 0.));
  EXPECT_TRUE(run.adapt(policy, 0.));
  EXPECT_LT(run.mesh.triangulation.n_global_active_cells(), cells);
}

TEST(ParallelMeshPolicy, KnowsForHowManyAcceptedStepsTheMeshHasBeenThere)
{
  CircleOnAdaptedMesh run(1000);
  MeshPolicy<2> policy = run.policy();
  run.adapt(policy, 0.);
  for (unsigned int i = 0; i < 3; ++i)
  {
    EXPECT_TRUE(policy.mesh_is_new());
    run.adapt(policy, 0.);
    policy.accept();
  }
  EXPECT_FALSE(policy.mesh_is_new());

  MeshPolicy<2> restored = run.policy();
  restored.restore(policy.get_memory(), policy.lowered_levels());
  EXPECT_FALSE(restored.mesh_is_new());
  EXPECT_EQ(restored.get_memory().steps_since_remeshing, 3u);
  policy.begin_anew();
  EXPECT_TRUE(policy.mesh_is_new());
}
