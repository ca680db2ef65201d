// SPDX-License-Identifier: LGPL-2.1-or-later
// doc/verification.md, section 2: the semi-Lagrangian level set in given velocity fields.
#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_transport.h>

#include <deal.II/base/function_lib.h>
#include <deal.II/base/function_signed_distance.h>
#include <deal.II/grid/grid_generator.h>

#include <cmath>
#include <functional>
#include <gtest/gtest.h>

#include "support/test_size.h"

namespace Gemmule
{
using namespace dealii;

namespace
{
  using VelocityField = std::function<Tensor<1, 2>(const Point<2> &, double)>;

  Tensor<1, 2> rotation(const Point<2> &p, const double)
  {
    const double angular_velocity = 2. * numbers::PI;
    return Tensor<1, 2>({-angular_velocity * p[1], angular_velocity * p[0]});
  }

  /** Swirl with stream function cos^2(pi x/2) cos^2(pi y/2) / pi, time-reversed at t = 1/2: back in place at
   * t = 1. */
  Tensor<1, 2> reversed_vortex(const Point<2> &p, const double t)
  {
    const double a = 0.5 * numbers::PI, strength = std::cos(numbers::PI * t);
    return strength *
           Tensor<1, 2>({-2. * std::pow(std::cos(a * p[0]), 2) * std::cos(a * p[1]) * std::sin(a * p[1]),
                         2. * std::pow(std::cos(a * p[1]), 2) * std::cos(a * p[0]) * std::sin(a * p[0])});
  }

  struct Errors
  {
    double shape; ///< largest distance of the membrane from the initial circle
    double area;  ///< relative, no correction
  };

  /** Advances an off-centre circle to t = 1, when the exact membrane is where it was. */
  Errors run(const VelocityField &velocity, const unsigned int level, const unsigned int n_steps,
             const bool remesh_each_step = false)
  {
    const Point<2> center(0.25, 0.1);
    const double radius = 0.3;
    parallel::distributed::Triangulation<2> triangulation(MPI_COMM_WORLD);
    GridGenerator::hyper_cube(triangulation, -1., 1.);
    triangulation.refine_global(level);
    Interface<2> interface(triangulation);
    interface.reinit_mesh();
    interface.interpolate(Functions::SignedDistance::Sphere<2>(center, radius));
    const CutGeometry<2> &geometry = interface.geometry();
    const Point<2> origin(-1., -1.);
    interface.cut();

    const double dt = 1. / n_steps;
    std::vector<TransportedFields<2>> transported(geometry.cut_cells().size());
    for (unsigned int step = 0; step < n_steps; ++step)
    {
      std::vector<MembraneFields<2>> fields(geometry.cut_cells().size());
      for (unsigned int c = 0; c < fields.size(); ++c)
        for (unsigned int i = 0; i < MembraneFields<2>::n; ++i)
        {
          fields[c].velocity[i] =
              velocity(geometry.cut_cells()[c].physical(TensorLagrange<2, 3>::node(i)), step * dt);
          fields[c].displacement[i] = transported[c].displacement[i];
          fields[c].velocity_1_back[i] = transported[c].velocity_1_back[i];
        }
      const auto patches = gather_patches(geometry.cut_cells(), fields, MPI_COMM_WORLD);
      const auto band = interface.level_set().gather_narrow_band();
      const MembraneProjection<2> projection(patches, origin);
      const MembraneMotion<2> motion(projection, TimeStep(dt, step == 0 ? 0. : dt));
      if (remesh_each_step)
      {
        // refine one half of the box, the other half in the next step
        for (const auto &cell : triangulation.active_cell_iterators())
          if (cell->is_locally_owned())
          {
            const bool fine = (cell->center()[0] > 0.) == (step % 2 == 0);
            if (fine && cell->level() == static_cast<int>(level))
              cell->set_refine_flag();
            else if (!fine && cell->level() > static_cast<int>(level))
              cell->set_coarsen_flag();
          }
        triangulation.execute_coarsening_and_refinement();
        interface.reinit_mesh();
      }
      interface.move(motion, NarrowBandLevelSet<2>(band, origin), projection.distance_drift() > 0.1);
      interface.cut();
      transported = transport_fields(motion, geometry.cut_cells());
    }

    double shape_error = 0.;
    for (const auto &cell : geometry.cut_cells())
      for (const auto &q : cell.surface_points)
        shape_error = std::max(shape_error, std::abs(cell.physical(q).distance(center) - radius));
    const double area = numbers::PI * radius * radius;
    return {Utilities::MPI::max(shape_error, MPI_COMM_WORLD),
            std::abs(geometry.enclosed_volume() - area) / area};
  }

  double order(const double coarse, const double fine)
  {
    return std::log2(coarse / fine);
  }
} // namespace

TEST(ParallelLevelSet, RotationIsSecondOrderInTime)
{
  const Errors coarse = run(rotation, 5, 100), fine = run(rotation, 5, 200);
  std::cout << "rotation, dt = 1/100, 1/200: shape " << coarse.shape << " " << fine.shape << ", area "
            << coarse.area << " " << fine.area << std::endl;
  EXPECT_GT(order(coarse.shape, fine.shape), 1.9);
  EXPECT_GT(order(coarse.area, fine.area), 1.9);
}

TEST(ParallelLevelSet, ReversedVortexIsSecondOrderInTime)
{
  const Errors coarse = run(reversed_vortex, 5, 40), fine = run(reversed_vortex, 5, 80);
  std::cout << "reversed vortex, dt = 1/40, 1/80: shape " << coarse.shape << " " << fine.shape << ", area "
            << coarse.area << " " << fine.area << std::endl;
  EXPECT_GT(order(coarse.shape, fine.shape), 1.9);
  EXPECT_LT(fine.shape, 5e-3);
}

TEST(LevelSet, ReversedVortexIsThirdOrderInSpace)
{
  if (Testing::is_reduced())
    GTEST_SKIP() << "the finer of its two meshes takes 320 steps; the coarser one has a test of its own";
  // The swirl draws the circle out to a crescent with cells as wide as its curvature radius on the coarse
  // mesh.
  const Errors coarse = run(reversed_vortex, 5, 80), fine = run(reversed_vortex, 6, 320);
  std::cout << "reversed vortex, h = 1/16, 1/32, dt = 1/80, 1/320: shape " << coarse.shape << " "
            << fine.shape << ", area " << coarse.area << " " << fine.area << std::endl;
  EXPECT_GT(order(coarse.shape, fine.shape), 3.);
  EXPECT_LT(fine.shape, 3e-5);
}

TEST(ParallelLevelSet, ABandHoldsTheCutCellsAndTheirNeighboursOnAnyMesh)
{
  // Cells of two sizes in a pattern that does not follow the circle, at many places.
  for (unsigned int i = 0; i < 12; ++i)
  {
    parallel::distributed::Triangulation<2> triangulation(MPI_COMM_WORLD);
    GridGenerator::hyper_cube(triangulation, -1., 1.);
    triangulation.refine_global(4);
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned() &&
          static_cast<int>(7. * (cell->center()[0] + 2.) + 3.3 * i * (cell->center()[1] + 2.)) % 2 == 0)
        cell->set_refine_flag();
    triangulation.execute_coarsening_and_refinement();
    Interface<2> interface(triangulation);
    interface.reinit_mesh();
    interface.interpolate(
        Functions::SignedDistance::Sphere<2>(Point<2>(0.01 * i, 0.007 * i * i), 0.2 + 0.0173 * i));
    interface.cut();
    const auto patches = gather_bare_patches(interface.geometry(), MPI_COMM_WORLD);
    interface.set_distance(MembraneProjection<2>(patches, Point<2>(-1., -1.)));
    interface.cut();
    EXPECT_TRUE(interface.is_accurate()) << i;
    // A membrane four cells away is another matter.
    interface.interpolate(
        Functions::SignedDistance::Sphere<2>(Point<2>(0.01 * i, 0.007 * i * i), 0.7 + 0.0173 * i));
    interface.cut();
    EXPECT_FALSE(interface.is_accurate()) << i;
  }
}

TEST(ParallelLevelSet, RemeshingInEveryStepCostsNoAccuracy)
{
  const Errors fixed = run(reversed_vortex, 5, 40), remeshed = run(reversed_vortex, 5, 40, true);
  EXPECT_LT(remeshed.shape, 1.05 * fixed.shape);
}
} // namespace Gemmule
