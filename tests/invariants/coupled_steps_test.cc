// SPDX-License-Identifier: LGPL-2.1-or-later
// Imposed flows, order in time, and what a step that is repeated or rejected leaves behind.
#include <gemmule/base/exceptions.h>

#include <cmath>
#include <gtest/gtest.h>

#include "support/coupled_run.h"

using namespace Gemmule;
using namespace Gemmule::Testing;

namespace
{
using dealii::Point;
using Map = std::function<Point<2>(const Point<2> &)>;

/**
 * Carries the ellipse x^2 + 2 y^2 = 1/4, without tension, with an imposed linear flow. Returns the largest
 * distance (to first order) from the exact ellipse, which @p back maps to the initial one.
 */
double error_in_imposed_flow(const std::string &flow, const Map &back, const double end,
                             const unsigned int n_steps, const unsigned int level)
{
  AllParameters parameters = small_case_with_tension("0");
  parameters.domain.boundary_velocity = flow;
  parameters.mesh.membrane_level = parameters.mesh.phase_boundary_level = level;
  CoupledSystem<2> system(parameters, MPI_COMM_WORLD);
  system.initialise();
  for (unsigned int i = 0; i < n_steps; ++i)
  {
    system.try_step(end / n_steps);
    system.accept();
  }
  double error = 0.;
  for (const auto &x : sample_membrane(system).points)
  {
    const Point<2> X = back(x);
    const double defect = X[0] * X[0] + 2. * X[1] * X[1] - 0.25;
    error = std::max(error, std::abs(defect) / std::hypot(2. * X[0], 4. * X[1]));
  }
  return error;
}

/** With 10, 20 and 40 steps, on cells of @p level that leave the errors to the time steps. */
void expect_second_order(const std::string &flow, const Map &back, const double end, const unsigned int level)
{
  std::array<double, 3> errors;
  for (unsigned int i = 0; i < 3; ++i)
    errors[i] = error_in_imposed_flow(flow, back, end, 10 << i, level);
  EXPECT_LT(errors[0], 3e-3);
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.75) << errors[0] << ' ' << errors[1];
  EXPECT_GT(std::log2(errors[1] / errors[2]), 1.75) << errors[1] << ' ' << errors[2];
}

void expect_same(const StatisticsRow &a, const StatisticsRow &b)
{
  EXPECT_DOUBLE_EQ(a.time, b.time);
  EXPECT_EQ(a.cells, b.cells);
  for (const auto figure :
       {&StatisticsRow::area, &StatisticsRow::arclength, &StatisticsRow::mass_f, &StatisticsRow::mass_total,
        &StatisticsRow::energy_total, &StatisticsRow::dissipation_viscous, &StatisticsRow::dissipation_phase,
        &StatisticsRow::max_velocity, &StatisticsRow::tension_min, &StatisticsRow::deformation,
        &StatisticsRow::centroid_x, &StatisticsRow::composition_max, &StatisticsRow::area_correction})
    EXPECT_NEAR(a.*figure, b.*figure, 1e-8 * (1. + std::abs(b.*figure)));
}

/** Phases whose mesh is fine enough around the membrane not to change during the test. */
AllParameters case_with_steady_mesh()
{
  AllParameters parameters = small_case();
  set_two_phases(parameters, "x-0.1");
  parameters.mesh.membrane_layers = 4;
  parameters.mesh.remeshing_interval = 1000;
  parameters.arclength.model = Parameters::ArclengthModel::penalty;
  return parameters;
}
} // namespace

TEST(CoupledImposedFlow, ExtensionKeepsAnEllipseElliptic)
{
  const double rate = 0.8, end = 0.5;
  expect_second_order(
      "-0.8*x; 0.8*y",
      [=](const Point<2> &p) { return Point<2>(p[0] * std::exp(rate * end), p[1] * std::exp(-rate * end)); },
      end, 6);
}

TEST(CoupledImposedFlow, OscillatingShearFollowsItsPhase)
{
  // The displacement is the integral of cos(3 t) y, and turns back at t = pi/6.
  const double end = 0.8;
  expect_second_order(
      "cos(3*t)*y; 0",
      [=](const Point<2> &p) { return Point<2>(p[0] - std::sin(3. * end) / 3. * p[1], p[1]); }, end, 5);
}

TEST(CoupledImposedFlow, UniformFlowCarriesTheMembraneWithStepsThatItBounds)
{
  // In a steady flow nothing but the travel of the membrane, in cells per step, limits the step: an estimate
  // of its error sees none.
  AllParameters parameters = small_case_with_tension("0");
  parameters.domain.boundary_velocity = "1; 0";
  parameters.membrane.level_set = "(x+0.3)^2+y^2-0.09";
  const double end = 0.5, cell = 1. / 16.;
  parameters.time_stepping.largest_step = end;
  const auto rows = run_with_step_control(parameters, end);
  EXPECT_LT(rows.size(), 30u);
  const StatisticsRow &first = rows.front(), &last = rows.back();
  EXPECT_NEAR(last.centroid_x - first.centroid_x, end, 1e-8);
  EXPECT_NEAR(last.arclength, first.arclength, 1e-5);
  EXPECT_NEAR(last.deformation, 0., 1e-5);

  CoupledSystem<2> system(parameters, MPI_COMM_WORLD);
  system.initialise();
  EXPECT_NEAR(system.time_step_limits().displacement, cell, 1e-3 * cell);
  EXPECT_NEAR(system.time_step_limits().longest_step(2.), 0.8 * cell, 1e-3 * cell);
  // Beyond the band of the level set there is no membrane to be found.
  for (const double cells : {3., 5.})
    EXPECT_THROW(system.try_step(cells * cell), SimulationError) << cells;
  system.try_step(1.5 * cell);
  EXPECT_NEAR(statistics_of(system).centroid_x - first.centroid_x, 1.5 * cell, 1e-6);
}

TEST(ParallelCoupledStep, CanBeRepeated)
{
  CoupledSystem<2> system(case_with_steady_mesh(), MPI_COMM_WORLD);
  system.initialise();
  for (const double dt : {0.005, 0.008, 0.01})
  {
    const auto first = system.try_step(dt);
    const auto row = statistics_of(system);
    const auto second = system.try_step(dt);
    EXPECT_NEAR(first.shape, second.shape, 1e-12);
    EXPECT_NEAR(first.composition, second.composition, 1e-12);
    EXPECT_GT(first.shape, 0.);
    expect_same(statistics_of(system), row);
    system.accept();
    expect_same(statistics_of(system), row);
  }
  EXPECT_DOUBLE_EQ(system.time(), 0.023);
  EXPECT_DOUBLE_EQ(system.last_step(), 0.01);
}

TEST(ParallelCoupledStep, RejectedStepLeavesNoTrace)
{
  CoupledSystem<2> plain(case_with_steady_mesh(), MPI_COMM_WORLD),
      retrying(case_with_steady_mesh(), MPI_COMM_WORLD);
  plain.initialise();
  retrying.initialise();
  for (const double dt : {0.004, 0.006, 0.005})
  {
    plain.try_step(dt);
    plain.accept();

    const double time = retrying.time(), last = retrying.last_step(),
                 limit = retrying.time_step_limits().longest_step(2.);
    retrying.try_step(3. * dt);
    EXPECT_EQ(retrying.time(), time);
    EXPECT_EQ(retrying.last_step(), last);
    EXPECT_EQ(retrying.time_step_limits().longest_step(2.), limit) << "the limit of the accepted state";
    EXPECT_DOUBLE_EQ(retrying.computed_time(), time + 3. * dt);
    retrying.try_step(dt);
    retrying.accept();
    expect_same(statistics_of(retrying), statistics_of(plain));
  }
}

TEST(CoupledStep, FailedStepLeavesNoTrace)
{
  // So long a step throws the membrane out of the box; the next one has to start from the accepted state.
  AllParameters parameters = case_with_steady_mesh();
  parameters.domain.boundary_velocity = "0.5; 0";
  CoupledSystem<2> plain(parameters, MPI_COMM_WORLD), failing(parameters, MPI_COMM_WORLD);
  plain.initialise();
  failing.initialise();
  for (const double dt : {0.004, 0.006})
  {
    plain.try_step(dt);
    plain.accept();
    const double limit = failing.time_step_limits().longest_step(2.);
    EXPECT_THROW(failing.try_step(2.), SimulationError);
    EXPECT_EQ(failing.time_step_limits().longest_step(2.), limit);
    failing.try_step(dt);
    failing.accept();
  }
  // The long try has changed the mesh around the place where the membrane would have gone.
  const auto a = statistics_of(failing), b = statistics_of(plain);
  EXPECT_NEAR(a.arclength, b.arclength, 1e-6);
  EXPECT_NEAR(a.centroid_x, b.centroid_x, 1e-6);
  EXPECT_NEAR(a.mass_f, b.mass_f, 1e-11);
  EXPECT_NEAR(a.area, b.area, 1e-11);
}
