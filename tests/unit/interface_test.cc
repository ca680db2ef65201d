// SPDX-License-Identifier: LGPL-2.1-or-later
// The level set and the cells that it cuts, as one object.
#include <gemmule/base/exceptions.h>
#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_transport.h>

#include <deal.II/base/function_signed_distance.h>

#include <cmath>
#include <gtest/gtest.h>

#include "support/level_set_mesh.h"

namespace Gemmule
{
using namespace dealii;
using Testing::LevelSetMesh;

namespace
{
  constexpr double radius = 0.45;

  template <int dim>
  double ball(const double r)
  {
    return dim == 2 ? numbers::PI * r * r : 4. / 3. * numbers::PI * r * r * r;
  }

  template <int dim>
  Point<dim> center()
  {
    Point<dim> p;
    p[0] = 0.013;
    p[1] = -0.027;
    return p;
  }

  /** A circle (sphere) on cells of 2 / 2^level. */
  template <int dim>
  struct Circle
  {
    LevelSetMesh<dim> mesh;
    Interface<dim> interface;

    explicit Circle(const unsigned int level) : mesh(level), interface(mesh.triangulation) { set(); }

    void set()
    {
      interface.reinit_mesh();
      interface.interpolate(Functions::SignedDistance::Sphere<dim>(center<dim>(), radius));
      interface.cut();
    }

    /** Largest distance of the membrane from the circle of radius @p r. */
    double error(const double r) const
    {
      double largest = 0.;
      for (const auto &cell : interface.geometry().cut_cells())
        for (const auto &point : cell.surface_points)
          largest = std::max(largest, std::abs(cell.physical(point).distance(center<dim>()) - r));
      return Utilities::MPI::max(largest, MPI_COMM_WORLD);
    }
  };

  /** Makes a circle larger or smaller by @p change of its volume, and looks at what has come out. */
  template <int dim>
  void expect_shift(const unsigned int level, const double change, const double tolerance)
  {
    Circle<dim> circle(level);
    const double target = (1. + change) * ball<dim>(radius), r = radius * std::pow(1. + change, 1. / dim);
    const double inwards = circle.interface.shift_to_volume(target);
    EXPECT_NEAR(inwards, radius - r, tolerance);
    EXPECT_NEAR(circle.interface.geometry().enclosed_volume() / target, 1., 1e-12);
    EXPECT_LT(circle.error(r), tolerance);
    EXPECT_EQ(circle.interface.shift_to_volume(target), 0.) << "nothing is left to be done";
  }
} // namespace

TEST(ParallelInterface, IsShiftedToAVolume)
{
  for (const double change : {0.04, 1e-6, -0.03})
    expect_shift<2>(4, change, 1e-4);
  expect_shift<3>(3, -0.03, 2e-3);
}

TEST(ParallelInterface, IsNotShiftedToAVolumeThatIsAnotherShape)
{
  Circle<2> circle(4);
  const double volume = circle.interface.geometry().enclosed_volume();
  EXPECT_THROW(circle.interface.shift_to_volume(1.06 * volume), StepBreakdown);
  EXPECT_THROW(circle.interface.shift_to_volume(0.94 * volume), StepBreakdown);
  EXPECT_EQ(circle.interface.geometry().enclosed_volume(), volume) << "a refusal changes nothing";

  circle.interface.interpolate(Functions::ConstantFunction<2>(1.));
  circle.interface.cut();
  EXPECT_THROW(circle.interface.shift_to_volume(volume), StepBreakdown) << "there is no membrane";
}

TEST(ParallelInterface, KeepsItsCutCellsUntilTheyAreCutAnew)
{
  Circle<2> circle(4);
  const CutGeometry<2> &geometry = circle.interface.geometry();
  const double volume = geometry.enclosed_volume();
  circle.interface.shift(0.01);
  EXPECT_EQ(geometry.enclosed_volume(), volume);
  circle.interface.cut();
  EXPECT_NEAR(geometry.enclosed_volume(), ball<2>(radius - 0.01), 1e-4);
}

TEST(ParallelInterface, HasAnAccurateLevelSetWhereADistanceHasBeenSet)
{
  Circle<2> circle(4);
  EXPECT_FALSE(circle.interface.is_accurate()) << "an interpolated function need not be a distance";
  const auto patches = gather_bare_patches(circle.interface.geometry(), MPI_COMM_WORLD);
  circle.interface.set_distance(MembraneProjection<2>(patches, Point<2>(-1., -1.)));
  circle.interface.cut();
  EXPECT_TRUE(circle.interface.is_accurate());

  // On another mesh nothing of it is left: the whole function is shifted, as on the first one.
  circle.mesh.refine_where([](const Point<2> &p) { return p[0] > 0.; });
  circle.set();
  EXPECT_FALSE(circle.interface.is_accurate());
  circle.interface.shift(-0.3);
  circle.interface.cut();
  EXPECT_LT(circle.error(radius + 0.3), 1e-3);
}
} // namespace Gemmule
