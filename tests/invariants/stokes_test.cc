// SPDX-License-Identifier: LGPL-2.1-or-later
// What the flow keeps for any position of the membrane: robustness, energy, volume, arclength penalty, ranks.
#include <gemmule/base/exceptions.h>
#include <gemmule/flow/arclength_constraint.h>

#include <deal.II/base/function_signed_distance.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <gtest/gtest.h>
#include <iostream>

#include "support/circle_flow.h"
#include "support/flow_on_circle.h"

using namespace dealii;
using namespace Gemmule;
using namespace Gemmule::Testing;

namespace
{
double stretching_tension(const Point<2> &p)
{
  return 1. + 0.5 * std::cos(2. * std::atan2(p[1], p[0]));
}

/** int u.n over the walls of the box. */
double flux_through_the_walls(const FlowOnCircle<2> &flow)
{
  StokesSolver<2>::Vector values;
  flow.solver.interpolate(values);
  values.update_ghost_values();
  const auto &handler = flow.solver.dof_handler();
  const QGauss<1> gauss(4);
  FEFaceValues<2> face_values(handler.get_fe(), gauss,
                              update_values | update_normal_vectors | update_JxW_values);
  std::vector<Tensor<1, 2>> velocity(gauss.size());
  double flux = 0.;
  for (const auto &cell : handler.active_cell_iterators())
    if (cell->is_locally_owned())
      for (const unsigned int f : cell->face_indices())
        if (cell->face(f)->at_boundary())
        {
          face_values.reinit(cell, f);
          face_values[FEValuesExtractors::Vector(0)].get_function_values(values, velocity);
          for (const unsigned int q : face_values.quadrature_point_indices())
            flux += velocity[q] * face_values.normal_vector(q) * face_values.JxW(q);
        }
  return Utilities::MPI::sum(flux, MPI_COMM_WORLD);
}
} // namespace

TEST(StokesInvariants, ErrorIsFlatOverSliverCuts)
{
  // The circle slides from tangency with a grid line (at 0.5 in x and y) through ever thicker slivers, over
  // one cell.
  const double h = 1. / 16.;
  double smallest = 1e300, largest = 0.;
  for (unsigned int i = 0; i < 20; ++i)
  {
    const double shift = i < 10 ? h * std::pow(10., -0.7 * (i + 1.)) : h * (i - 9.) / 10.;
    const Point<2> center(0.05 + shift, 0.05 - 0.3 * shift);
    const CircleFlow exact(center, FlowOnCircle<2>::radius, 2, 0.5, 10.);
    FlowOnCircle<2> flow(5, center, 10.);
    flow.set_tension([&](const Point<2> &p) { return exact.tension(p); });
    flow.solve(exact);
    const double error = flow.error([&](const Point<2> &p) { return exact.velocity(p); });
    smallest = std::min(smallest, error);
    largest = std::max(largest, error);
  }
  std::cout << "error over 20 cuts between " << smallest << " and " << largest << std::endl;
  EXPECT_LT(largest, 2e-4);
  EXPECT_LT(largest, 2.5 * smallest);
}

TEST(ParallelStokesInvariants, DissipationIsTheWorkOfTheMembrane)
{
  for (const double capillary_number : {1., 0.2})
    for (const double ratio : {0.1, 10.})
    {
      FlowOnCircle<2> flow(5, Point<2>(0.013, 0.007), ratio, {}, capillary_number);
      flow.set_tension(stretching_tension);
      flow.solve(Functions::ZeroFunction<2>(2));
      const double work = flow.solver.membrane_work();
      EXPECT_GT(work, 0.);
      EXPECT_NEAR(flow.solver.viscous_dissipation(), work, 2e-3 * work);
      EXPECT_NEAR(flow.solver.net_flux(), 0., 1e-8 / capillary_number);
    }
}

TEST(ParallelStokesInvariants, ArclengthPenaltyActsAtTheEndOfTheStep)
{
  // A tension that contracts an ellipse-like force field: the penalty must find s = Lambda (L - L0 + dt
  // dL/dt).
  const double dt = 0.01, excess = 2e-3;
  FlowOnCircle<2> flow(5, Point<2>(0.013, 0.007));
  flow.set_tension(stretching_tension);
  flow.set_membrane(Functions::SignedDistance::Ellipsoid<2>(flow.center, {{0.5, 0.35}}));
  flow.set_tension(stretching_tension);
  const Functions::ZeroFunction<2> walls_at_rest(2);

  flow.solve(walls_at_rest);
  const double free_rate = flow.solver.arclength_rate();
  EXPECT_LT(free_rate, -1e-2);

  for (const double stiffness : {0., 1., 100., 1e4, 1e6})
  {
    const auto constraint = std::make_shared<ArclengthConstraint<2>>(
        ArclengthConstraint<2>::Penalty{stiffness, excess, dt}, flow.fluid.capillary_number);
    flow.solve(walls_at_rest, {constraint});
    const double rate = flow.solver.arclength_rate(), s = constraint->tension();
    // s = Lambda (L - L0 + dt rate): the bracket is a small difference for large Lambda, known to round-off
    // only.
    EXPECT_NEAR(s, stiffness * (excess + dt * rate), 1e-9 * std::abs(s) + stiffness * 1e-14);
    if (stiffness == 0.)
    {
      EXPECT_NEAR(rate, free_rate, 1e-13);
    }
    if (stiffness >= 1e6)
    {
      EXPECT_NEAR(rate, -excess / dt, 1e-3 * excess / dt);
    }

    // The same flow from the total tension given explicitly.
    const MembranePointValues given = flow.tension;
    const double work = flow.solver.membrane_work();
    for (auto &cell : flow.tension)
      for (auto &sigma : cell)
        sigma += s;
    flow.solve(walls_at_rest);
    EXPECT_NEAR(flow.solver.arclength_rate(), rate, 1e-10);
    EXPECT_NEAR(flow.solver.membrane_work(), work, 1e-10 * (1. + std::abs(s)));
    EXPECT_NEAR(flow.solver.viscous_dissipation(), work, 5e-3 * work);
    flow.tension = given;
  }
}

TEST(ParallelStokesInvariants, MembraneVelocityHasTheGradientOfItsValues)
{
  FlowOnCircle<2> flow(4, Point<2>(0.013, 0.007), 10.);
  flow.set_tension(stretching_tension);
  flow.solve(Functions::ZeroFunction<2>(2));
  double largest = 0., rate = 0.;
  for (unsigned int k = 0; k < flow.geometry.cut_cells().size(); ++k)
  {
    const auto &cell = flow.geometry.cut_cells()[k];
    const auto &velocity = flow.solver.membrane_velocity()[k];
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      const Point<2> p = cell.surface_points[q];
      const auto gradient = velocity.gradient(p);
      rate += cell.surface_weights[q] * (trace(gradient) - cell.normals[q] * (gradient * cell.normals[q]));
      for (unsigned int d = 0; d < 2; ++d)
      {
        // Central differences of a quadratic are exact.
        Tensor<1, 2> step;
        step[d] = 0.01;
        const auto difference = (velocity.value(p + step) - velocity.value(p - step)) / (0.02 * cell.size);
        for (unsigned int c = 0; c < 2; ++c)
          largest = std::max(largest, std::abs(difference[c] - gradient[c][d]));
      }
    }
  }
  EXPECT_LT(largest, 1e-11);
  EXPECT_NEAR(Utilities::MPI::sum(rate, MPI_COMM_WORLD), flow.solver.arclength_rate(), 1e-13);
}

TEST(ParallelStokesInvariants, ImposedFlowLosesItsNetFlux)
{
  // Divergence-free, but not in Q2: the interpolant has a net flux, which is removed.
  class Swirl : public Function<2>
  {
  public:
    Swirl(const double factor = 1.) : Function<2>(2), factor(factor) {}
    double value(const Point<2> &p, const unsigned int c) const override
    {
      // curl of exp(x y + 0.3 x)
      const double e = factor * std::exp(p[0] * p[1] + 0.3 * p[0]);
      return c == 0 ? p[0] * e : -(p[1] + 0.3) * e;
    }

  private:
    const double factor;
  };
  FlowOnCircle<2> flow(4, Point<2>(0.013, 0.007));
  flow.set_tension([](const Point<2> &) { return 0.; });
  flow.solve(Swirl());
  const double removed = flow.solver.removed_boundary_flux();
  EXPECT_GT(std::abs(removed), 1e-9);
  EXPECT_LT(std::abs(removed), 1e-3);
  EXPECT_NEAR(flow.solver.net_flux(), 0., 1e-6);
  EXPECT_NEAR(flux_through_the_walls(flow), 0., 1e-6 * std::abs(removed));
  // The same with the other sign: what pumps inwards is removed as well.
  flow.solve(Swirl(-1.));
  EXPECT_NEAR(flow.solver.removed_boundary_flux(), -removed, 1e-6 * std::abs(removed));
  EXPECT_NEAR(flux_through_the_walls(flow), 0., 1e-6 * std::abs(removed));

  class Source : public Function<2>
  {
  public:
    Source() : Function<2>(2) {}
    double value(const Point<2> &p, const unsigned int c) const override { return p[c]; }
  };
  EXPECT_THROW(flow.solve(Source()), UserError);
}

TEST(ParallelStokesInvariants, LinearFlowIsExactUpToQuadrature)
{
  // Without tension and with equal viscosities the discrete space holds a linear flow: what remains is the
  // error of the quadrature on the cut cells. Hanging nodes must not disturb it.
  class LinearFlow : public Function<2>
  {
  public:
    LinearFlow() : Function<2>(2) {}
    double value(const Point<2> &p, const unsigned int c) const override
    {
      return c == 0 ? 0.3 + 0.7 * p[1] - 0.2 * p[0] : 0.2 * p[1] - 0.1 * p[0] + 0.05;
    }
  } exact;
  const std::array<double, 3> bound{{5e-6, 1e-7, 1e-8}};
  for (const unsigned int level : {4, 5, 6})
  {
    FlowOnCircle<2> flow(level, Point<2>(0.013, 0.007), 1.,
                         [](const Point<2> &p) { return p[0] + 0.4 * p[1] > 0.05; });
    flow.set_tension([](const Point<2> &) { return 0.; });
    flow.solve(exact);
    const double error = flow.error(
        [&](const Point<2> &p)
        {
          Tensor<1, 2> u;
          u[0] = exact.value(p, 0);
          u[1] = exact.value(p, 1);
          return u;
        });
    EXPECT_LT(error, bound[level - 4]);
  }
}

TEST(ParallelStokesInvariants, MembraneAtTheWallIsRefused)
{
  FlowOnCircle<2> flow(4, Point<2>(0.5, 0.));
  flow.set_tension([](const Point<2> &) { return 1.; });
  EXPECT_THROW(flow.solve(Functions::ZeroFunction<2>(2)), SimulationError);
}

TEST(ParallelStokesInvariants, SameResultOnAnyNumberOfRanks)
{
  // Reference figures of one rank. Single refined cells everywhere: hanging nodes on cut cells, on faces
  // between ranks and at the far side of ghost cells.
  const auto scattered = [](const Point<2> &p)
  { return (7 * static_cast<int>(8. * (p[0] + 1.)) + 3 * static_cast<int>(8. * (p[1] + 1.))) % 4 == 0; };
  FlowOnCircle<2> flow(4, Point<2>(0.013, 0.007), 10., scattered);
  flow.set_tension(stretching_tension);
  flow.solve(Functions::ZeroFunction<2>(2));
  LinearAlgebra::distributed::Vector<double> values;
  flow.solver.interpolate(values);
  EXPECT_EQ(flow.solver.n_unknowns(), 3775u);
  EXPECT_NEAR(flow.solver.viscous_dissipation(), 0.069293620534532, 1e-11);
  EXPECT_NEAR(flow.solver.max_velocity(), 0.020829302746386, 1e-11);
  EXPECT_NEAR(values.l2_norm(), 22.537558723468, 1e-9);
}

TEST(StokesInvariants, StaticSphere)
{
  FlowOnCircle<3> flow(3, Point<3>(0.013, 0.007, -0.004));
  flow.set_tension([](const Point<3> &) { return 1.; });
  flow.solve(Functions::ZeroFunction<3>(3));
  std::cout << flow.solver.n_unknowns() << " unknowns, max |u| " << flow.solver.max_velocity() << std::endl;
  EXPECT_LT(flow.solver.max_velocity(), 5e-3);
  EXPECT_NEAR(flow.solver.net_flux(), 0., 1e-4);
  // Laplace's law with two radii of curvature.
  EXPECT_LT(flow.largest_pressure_error(2. / flow.radius), 0.1 * 2. / flow.radius);

  // And a tension that makes it flow, along the membrane and across it.
  flow.set_tension([](const Point<3> &p) { return 1. + 0.5 * (p[0] + p[1] * p[2] / 0.45) / 0.45; });
  flow.solve(Functions::ZeroFunction<3>(3));
  const double work = flow.solver.membrane_work();
  std::cout << "dissipation " << flow.solver.viscous_dissipation() << ", work of the membrane " << work
            << std::endl;
  EXPECT_GT(work, 0.);
  EXPECT_NEAR(flow.solver.viscous_dissipation(), work, 0.05 * work);
}
