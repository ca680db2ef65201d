// SPDX-License-Identifier: LGPL-2.1-or-later
// Flow driven by a circular membrane against exact solutions (doc/verification.md, section 3).
#include <deal.II/base/convergence_table.h>
#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <iostream>

#include "support/circle_flow.h"
#include "support/flow_on_circle.h"
#include "support/sphere_flow.h"

using namespace dealii;
using namespace Gemmule;
using namespace Gemmule::Testing;

namespace
{
const Point<2> center(0.0137, 0.0071); // slightly off the grid

void print(const ConvergenceTable &table)
{
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    table.write_text(std::cout, TableHandler::org_mode_table);
}

/** Errors of <u> on the membrane at h = 1/8, 1/16, 1/32. */
std::vector<double> errors(const unsigned int mode, const double viscosity_ratio,
                           const std::function<bool(const Point<2> &)> &refine = {})
{
  const CircleFlow exact(center, FlowOnCircle<2>::radius, mode, 0.5, viscosity_ratio);
  ConvergenceTable table;
  std::vector<double> result;
  for (const unsigned int level : {4, 5, 6})
  {
    FlowOnCircle<2> flow(level, center, viscosity_ratio, refine);
    flow.set_tension([&](const Point<2> &p) { return exact.tension(p); });
    flow.solve(exact);
    result.push_back(flow.error([&](const Point<2> &p) { return exact.velocity(p); }));
    table.add_value("1/h", std::pow(2., level - 1));
    table.add_value("mode", mode);
    table.add_value("viscosity ratio", viscosity_ratio);
    table.add_value("unknowns", flow.solver.n_unknowns());
    table.add_value("error of <u>", result.back());
    table.add_value("net flux", flow.solver.net_flux());
    EXPECT_LT(std::abs(flow.solver.net_flux()), 1e-6 * std::pow(0.25, level - 4.));
  }
  for (const auto &column : {"error of <u>", "net flux"})
  {
    table.set_precision(column, 2);
    table.set_scientific(column, true);
  }
  table.evaluate_convergence_rates("error of <u>", ConvergenceTable::reduction_rate_log2);
  print(table);
  return result;
}

double order(const std::vector<double> &e)
{
  return 0.5 * std::log2(e.front() / e.back());
}
} // namespace

class StokesConvergence : public ::testing::TestWithParam<double>
{
};

TEST_P(StokesConvergence, StretchingModeIsThirdOrder)
{
  const auto e = errors(2, GetParam());
  EXPECT_GE(order(e), 2.7);
  EXPECT_GE(std::log2(e[1] / e[2]), 2.7);
  if (GetParam() == 1.)
  {
    EXPECT_LT(e[2], 2e-5);
  }
}

TEST_P(StokesConvergence, TranslatingModeIsThirdOrder)
{
  const auto e = errors(1, GetParam());
  EXPECT_GE(order(e), 2.7);
  EXPECT_GE(std::log2(e[1] / e[2]), 2.7);
}

INSTANTIATE_TEST_SUITE_P(ViscosityRatios, StokesConvergence, ::testing::Values(0.01, 1., 10., 100.));

TEST(ParallelStokesConvergence, HangingNodesOnCutCells)
{
  // Refinement edges cross the membrane twice, and run inside and outside of it.
  const auto right = [](const Point<2> &p) { return p[0] > 0.1 && std::abs(p[1]) < 0.7; };
  const auto e = errors(2, 1., right);
  EXPECT_GE(order(e), 2.7);
  EXPECT_LT(e[2], 2e-5);
  const auto uniform = errors(2, 1.);
  for (unsigned int i = 0; i < 3; ++i)
    EXPECT_LT(e[i], 1.1 * uniform[i]);
}

TEST(ParallelStokesConvergence, ScatteredRefinement)
{
  // A checkerboard of refined patches: hanging nodes on many cut cells, at all angles.
  const auto checkerboard = [](const Point<2> &p)
  { return (static_cast<int>(std::floor(8. * p[0])) + static_cast<int>(std::floor(8. * p[1]))) % 2 == 0; };
  for (const double ratio : {1., 100.})
  {
    const auto e = errors(2, ratio, checkerboard);
    EXPECT_GE(order(e), 2.7);
  }
}

TEST(ParallelStokesConvergence, StaticDropHasNoCurrents)
{
  const std::vector<double> bound{{1e-4, 1e-5, 1e-6}};
  ConvergenceTable table;
  for (const unsigned int level : {4, 5, 6})
  {
    FlowOnCircle<2> flow(level, center);
    flow.set_tension([](const Point<2> &) { return 1.; });
    flow.solve(Functions::ZeroFunction<2>(2));
    table.add_value("1/h", std::pow(2., level - 1));
    table.add_value("max |u|", flow.solver.max_velocity());
    EXPECT_LE(flow.solver.max_velocity(), bound[level - 4]);

    // Laplace's law: the jump of the pressure is sigma / R, its mean zero.
    const double largest_error = flow.largest_pressure_error(1. / flow.radius);
    table.add_value("error of the pressure", largest_error);
    EXPECT_LE(largest_error, 0.02 * std::pow(0.25, level - 4.));
  }
  for (const auto &column : {"max |u|", "error of the pressure"})
  {
    table.set_precision(column, 2);
    table.set_scientific(column, true);
    table.evaluate_convergence_rates(column, ConvergenceTable::reduction_rate_log2);
  }
  print(table);
}

TEST(ParallelStokesConvergence, NoSlipBox)
{
  // W3 of the design: the largest speeds on the circle (u_theta at 45 degrees, u_r at 0), which a
  // boundary-integral solution knows to all digits given. They hold modes 2, 6, 10, ..., because the box is
  // no circle.
  FlowOnCircle<2> flow(5, Point<2>());
  flow.set_tension([](const Point<2> &p) { return 1. + 0.5 * std::cos(2. * std::atan2(p[1], p[0])); });
  flow.solve(Functions::ZeroFunction<2>(2));
  double radial = 0., tangential = 0.;
  flow.integrate(
      [&](const Point<2> &, const Tensor<1, 2> &n, const Tensor<1, 2> &u)
      {
        radial = std::max(radial, std::abs(u * n));
        tangential = std::max(tangential, std::abs(u[1] * n[0] - u[0] * n[1]));
        return 0.;
      });
  EXPECT_NEAR(Utilities::MPI::max(tangential, MPI_COMM_WORLD), 0.09923756, 1e-3 * 0.09923756);
  EXPECT_NEAR(Utilities::MPI::max(radial, MPI_COMM_WORLD), 0.02832717, 1e-3 * 0.02832717);

  // The sum of the modes averages pointwise errors out.
  radial = tangential = 0.;
  for (const int mode : {2, 6, 10})
  {
    radial += flow.integrate([&](const Point<2> &p, const Tensor<1, 2> &n, const Tensor<1, 2> &u)
                             { return (u * n) * std::cos(mode * std::atan2(p[1], p[0])); });
    tangential +=
        flow.integrate([&](const Point<2> &p, const Tensor<1, 2> &n, const Tensor<1, 2> &u)
                       { return (u[1] * n[0] - u[0] * n[1]) * std::sin(mode * std::atan2(p[1], p[0])); }) *
        std::sin(mode * numbers::PI / 4.);
  }
  EXPECT_NEAR(std::abs(tangential) / (numbers::PI * flow.radius), 0.09923756, 2e-4 * 0.09923756);
  EXPECT_NEAR(std::abs(radial) / (numbers::PI * flow.radius), 0.02832717, 5e-4 * 0.02832717);
}

TEST(ParallelStokesConvergence3D, TheFlowOfASphereIsThirdOrder)
{
  const Point<3> origin(0.013, 0.007, -0.011);
  ConvergenceTable table;
  std::vector<double> result;
  for (const unsigned int level : {3, 4})
  {
    // Cells of half the size around the sphere.
    const double width = 0.9 * std::sqrt(3.) / std::pow(2., level);
    FlowOnCircle<3> flow(level, origin, 1.,
                         [&](const Point<3> &p)
                         { return std::abs(p.distance(origin) - FlowOnCircle<3>::radius) < width; });
    const SphereFlow exact(origin, FlowOnCircle<3>::radius, 2, 0.5, 1.);
    flow.set_tension([&](const Point<3> &p) { return exact.tension(p); });
    StokesSolver<3> iterative(flow.mesh.triangulation, flow.fluid, Parameters::Flow());
    iterative.reinit_mesh();
    iterative.prepare(flow.geometry, exact, {std::make_shared<TensionForce<3>>(flow.tension, 1.)});
    iterative.solve();
    result.push_back(flow.error([&](const Point<3> &p) { return exact.velocity(p); }, iterative));
    table.add_value("1/h", std::pow(2., level));
    table.add_value("unknowns", iterative.n_unknowns());
    table.add_value("iterations", iterative.linear_solver_report().iterations);
    table.add_value("error of <u>", result.back());
  }
  table.set_precision("error of <u>", 2);
  table.set_scientific("error of <u>", true);
  table.evaluate_convergence_rates("error of <u>", ConvergenceTable::reduction_rate_log2);
  print(table);
  EXPECT_GE(std::log2(result[0] / result[1]), 2.7);
}
