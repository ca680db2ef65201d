// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/coupling/active_bending.h>

#include <deal.II/base/function_signed_distance.h>

#include <gtest/gtest.h>
#include <iostream>

#include "support/surface_harness.h"

using namespace Gemmule;
using namespace Gemmule::Testing;

namespace
{
constexpr double radius = 0.45;

struct BendingOnCircle
{
  SurfaceHarness harness{4};
  TimerOutput timer{std::cout, TimerOutput::never, TimerOutput::cpu_times};
  BendingModel model;
  ActiveBending<2> bending;

  explicit BendingOnCircle(const double rigidity)
      : model(parameters_with(rigidity)), bending(harness.mesh.triangulation, model, 1., timer)
  {
    bending.reinit_mesh();
    harness.set_membrane(Functions::SignedDistance::Sphere<2>(Point<2>(0.013, -0.027), radius));
  }

  static Parameters::Bending parameters_with(const double rigidity)
  {
    Parameters::Bending parameters;
    parameters.rigidity_0 = parameters.rigidity_1 = rigidity;
    return parameters;
  }

  /** Does the membrane resist bending now? If so its curvature has to be that of the circle. */
  bool resists()
  {
    bending.compute_curvature(harness.interface);
    if (bending.get() == nullptr)
    {
      EXPECT_EQ(bending.curvature(), nullptr);
      return false;
    }
    for (const auto &cell : *bending.curvature())
      for (const double curvature : cell)
        EXPECT_NEAR(curvature, 1. / radius, 0.05);
    return true;
  }
};
} // namespace

TEST(ParallelActiveBending, IsThereWithARigidityOfThePhases)
{
  BendingOnCircle circle(0.1);
  EXPECT_TRUE(circle.resists());
  circle.bending.grid_scale().resist_negative_tension(-1., 0.125);
  EXPECT_TRUE(circle.resists());
  circle.bending.grid_scale().set(0.);
  EXPECT_TRUE(circle.resists());
}

TEST(ParallelActiveBending, ComesAndGoesWithTheRigidityOfTheGrid)
{
  BendingOnCircle circle(0.);
  EXPECT_FALSE(circle.resists());
  circle.bending.grid_scale().resist_negative_tension(-1., 0.125);
  EXPECT_NEAR(circle.bending.grid_scale().value(), 0.125 * 0.125, 1e-15);
  EXPECT_TRUE(circle.resists());
  // On a mesh that has changed meanwhile, too.
  circle.harness.mesh.refine_where([](const Point<2> &p) { return p[0] > 0.; });
  circle.bending.reinit_mesh();
  circle.harness.set_membrane(Functions::SignedDistance::Sphere<2>(Point<2>(0.013, -0.027), radius));
  EXPECT_TRUE(circle.resists());
  circle.bending.grid_scale().resist_negative_tension(0.5, 0.125);
  EXPECT_FALSE(circle.resists());
}
