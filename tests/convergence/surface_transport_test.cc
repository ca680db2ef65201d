// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/surface/conservative_transport.h>
#include <gemmule/surface/smoothed_update.h>
#include <gemmule/surface/trace_forms.h>

#include <deal.II/base/convergence_table.h>

#include <gtest/gtest.h>
#include <iostream>

#include "support/ellipse_distance.h"
#include "support/surface_harness.h"
#include "support/test_size.h"

using namespace Gemmule;
using namespace Gemmule::Testing;

namespace
{
/** A curve that moves with a known velocity, and what becomes of a concentration on it. */
struct Motion
{
  std::function<EllipseDistance(double)> distance;
  SurfaceHarness::VectorField velocity;
  std::function<double(const Point<2> &, double)> concentration;
};

double initial_concentration(const Point<2> &x)
{
  return 1. + 0.3 * std::sin(4. * x[0] + 1.) * std::cos(3. * x[1]);
}

Motion translation()
{
  const Tensor<1, 2> u = Point<2>(0.1, 0.06);
  const Point<2> start(-0.11, -0.07);
  return {[=](double t) { return EllipseDistance(start + t * u, 0.5, 0.4); },
          [=](const Point<2> &) { return u; },
          [=](const Point<2> &x, double t) { return initial_concentration(x - t * u); }};
}

/** u = (x, -y)/5: a circle becomes an ellipse; densities change with the stretch of the curve. */
Motion strain()
{
  constexpr double rate = 0.2, radius = 0.5;
  return {[=](double t)
          { return EllipseDistance({}, radius * std::exp(rate * t), radius * std::exp(-rate * t)); },
          [=](const Point<2> &x) { return Tensor<1, 2>(Point<2>(rate * x[0], -rate * x[1])); },
          [=](const Point<2> &x, double t)
          {
            const double a = std::exp(rate * t);
            const Point<2> start(x[0] / a, x[1] * a);
            const double stretch = std::hypot(a * start[1], start[0] / a) / start.norm();
            return initial_concentration(start) / stretch;
          }};
}

/** The concentration at t = 0.4 with exact starting values; @p harness is left with the membrane of then. */
TraceField<2> transport(SurfaceHarness &harness, const Motion &motion, const unsigned int n_steps)
{
  const double dt = 0.4 / n_steps;
  ConservativeTransport<2> scheme(0., 1., MPI_COMM_WORLD);
  TraceSpace<2> space(harness.mesh.triangulation);
  space.reinit_mesh();

  const auto exact_cloud = [&](const double t)
  {
    harness.set_membrane(motion.distance(t));
    const auto f = [&](const Point<2> &x) { return motion.concentration(x, t); };
    return harness.cloud(f, f);
  };
  MembraneCloud<2> older = exact_cloud(-dt), newer = exact_cloud(0.);
  TraceField<2> field;
  for (unsigned int n = 1; n <= n_steps; ++n)
  {
    harness.set_membrane(motion.distance(n * dt));
    const auto velocity = harness.vector(motion.velocity);
    SurfaceStep<2> step;
    step.time_step = dt;
    step.bdf = BdfCoefficients::second_order(1.);
    step.clouds = {{&newer, &older}};
    step.velocity = &velocity;
    space.prepare(harness.interface, step.clouds);
    field = scheme.advance(space, step);
    older = std::move(newer);
    newer = harness.cloud(field);
  }
  return field;
}

double transport_error(const Motion &motion, const unsigned int level, const unsigned int n_steps)
{
  SurfaceHarness harness(level);
  const auto field = transport(harness, motion, n_steps);
  return harness.l2_error(field, [&](const Point<2> &x) { return motion.concentration(x, 0.4); });
}

void print(const std::string &title, ConvergenceTable &table)
{
  table.set_scientific("error", true);
  table.evaluate_convergence_rates("error", ConvergenceTable::reduction_rate_log2);
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
  {
    std::cout << title << '\n';
    table.write_text(std::cout);
  }
}

void expect_orders(const std::string &name, const Motion &motion)
{
  ConvergenceTable in_space;
  std::vector<double> errors;
  // Reduced: without the finest mesh, and the order in space alone.
  const unsigned int finest_level = is_reduced() ? 5 : 6;
  for (unsigned int level = 4; level <= finest_level; ++level)
  {
    const unsigned int n_steps =
        10u << (2 * (level - 4)); // the time error falls faster than that of the mesh
    errors.push_back(transport_error(motion, level, n_steps));
    in_space.add_value("cells per unit length", 1u << (level - 1));
    in_space.add_value("steps", n_steps);
    in_space.add_value("error", errors.back());
  }
  print(name + ", order in h", in_space);
  EXPECT_GT(std::log2(errors[0] / errors[1]), 2.5);
  if (is_reduced())
    return;
  EXPECT_GT(std::log2(errors[1] / errors[2]), 2.5);
  EXPECT_LT(errors[2], 2e-5);

  // The error of the time steps alone: against many steps on the same mesh.
  ConvergenceTable in_time;
  errors.clear();
  SurfaceHarness harness(5);
  const auto reference = transport(harness, motion, 640);
  for (const unsigned int n_steps : {20, 40, 80, 160})
  {
    auto difference = transport(harness, motion, n_steps);
    for (unsigned int k = 0; k < difference.size(); ++k)
      for (unsigned int i = 0; i < difference[k].size(); ++i)
        difference[k][i] -= reference[k][i];
    errors.push_back(harness.l2_error(difference, [](const Point<2> &) { return 0.; }));
    in_time.add_value("steps", n_steps);
    in_time.add_value("error", errors.back());
  }
  print(name + ", order in dt", in_time);
  // The kinks of the test functions that the membrane crosses cost accuracy until a step is a small part of a
  // cell: the order shows in the finer steps (doc/measurements.md).
  EXPECT_GT(std::log2(errors[1] / errors[3]) / 2., 1.8);
}
} // namespace

TEST(SurfaceTransport, TranslationIsOfSecondOrderInTimeAndNearlyThirdInSpace)
{
  expect_orders("translating ellipse", translation());
}

TEST(SurfaceTransport, StrainIsOfSecondOrderInTimeAndNearlyThirdInSpace)
{
  expect_orders("strained circle", strain());
}

// The filter's factor for the mode cos(k theta) on a circle of radius R.
TEST(ParallelUpdateSmoothing, ModesDecayAsTheory)
{
  const double radius = 0.45, smoothing = 0.01;
  for (const unsigned int k : {0, 1, 2, 3, 4})
  {
    ConvergenceTable table;
    std::vector<double> errors;
    const double factor = 1. / (1. + smoothing * std::pow(k / radius, 4.));
    for (const unsigned int level : {3, 4, 5})
    {
      SurfaceHarness harness(level);
      harness.set_membrane(EllipseDistance({}, radius, radius));
      TraceSpace<2> space(harness.mesh.triangulation);
      space.reinit_mesh();
      space.prepare(harness.interface, {{nullptr, nullptr}});
      std::vector<std::vector<double>> source;
      const auto mode = [&](const Point<2> &x) { return std::cos(k * std::atan2(x[1], x[0])); };
      for (const auto &cell : harness.geometry.cut_cells())
      {
        source.emplace_back();
        for (const auto &p : cell.surface_points)
          source.back().push_back(-mode(cell.physical(p)));
      }
      SmoothedUpdate<2> update(smoothing, 1., MPI_COMM_WORLD);
      const auto rate = update.smoothed_rate(space, source);
      errors.push_back(harness.l2_error(rate, [&](const Point<2> &x) { return factor * mode(x); }) / factor);
      table.add_value("cells per unit length", 1u << (level - 1));
      table.add_value("error", errors.back());
      // the mean is not filtered
      EXPECT_NEAR(harness.integrate(rate, [](double r, const Point<2> &) { return r; }),
                  harness.integrate(rate, [&](double, const Point<2> &x) { return mode(x); }), 1e-9);
    }
    if (k == 0)
    {
      EXPECT_LT(errors.back(), 1e-9);
      continue;
    }
    print("update smoothing, mode " + std::to_string(k), table);
    EXPECT_LT(errors.back(), 2e-3);
    EXPECT_GT(std::log2(errors[0] / errors[2]) / 2., 2.5);
  }
}

// With a vanishing coefficient update smoothing is plain transport of the extended field.
TEST(SurfaceTransport, UpdateWithoutSmoothingTransports)
{
  const auto motion = strain();
  ConvergenceTable table;
  std::vector<double> errors;
  for (const unsigned int n_steps : {10, 20, 40})
  {
    const double dt = 0.4 / n_steps;
    SurfaceHarness harness(5);
    SmoothedUpdate<2> scheme(1e-14, 1., MPI_COMM_WORLD);
    TraceSpace<2> space(harness.mesh.triangulation);
    space.reinit_mesh();
    // one step from the exact past: its error is dt times the error of the rate
    const double t = 0.4;
    const auto extended = [&](const double time)
    {
      // constant along the normals of the ellipse at that time
      const double a = 0.5 * std::exp(0.2 * time), b = 0.5 * std::exp(-0.2 * time);
      const EllipseDistance distance({}, a, b);
      return harness.scalar(
          [&, a, b, distance, time](const Point<2> &x)
          {
            const double s = 1e-4;
            Point<2> y = x;
            for (unsigned int i = 0; i < 3; ++i)
            {
              const double d = distance.value(y);
              Tensor<1, 2> normal;
              for (unsigned int e = 0; e < 2; ++e)
              {
                Point<2> right = y, left = y;
                right[e] += s;
                left[e] -= s;
                normal[e] = (distance.value(right) - distance.value(left)) / (2. * s);
              }
              y -= d * normal / normal.norm();
            }
            return motion.concentration(y, time);
          });
    };
    harness.set_membrane(motion.distance(t - dt));
    const auto at = [&](const double time)
    { return [&motion, time](const Point<2> &x) { return motion.concentration(x, time); }; };
    const auto cloud = harness.cloud(at(t - dt), at(t - dt));
    harness.set_membrane(motion.distance(t));
    const auto velocity = harness.vector(motion.velocity);
    const auto predicted = extended(t), newer = extended(t - dt), older = extended(t - 2. * dt);
    SurfaceStep<2> step;
    step.time_step = dt;
    step.bdf = BdfCoefficients::second_order(1.);
    step.clouds = {{&cloud, nullptr}};
    step.velocity = &velocity;
    step.predicted_total_concentration = &predicted;
    step.extended_total_concentration = {{&newer, &older}};
    space.prepare(harness.interface, step.clouds);
    const auto field = scheme.advance(space, step);
    errors.push_back(harness.l2_error(field, at(t)));
    table.add_value("steps", n_steps);
    table.add_value("shift", scheme.last_shift());
    table.add_value("error", errors.back());
    EXPECT_LT(std::abs(scheme.last_shift()), 1e-5);
    const auto result = harness.cloud(field);
    EXPECT_NEAR(SurfaceHarness::mass(result, result.total_concentration),
                SurfaceHarness::mass(cloud, cloud.total_concentration), 1e-12);
  }
  table.set_scientific("shift", true);
  print("one step of update smoothing with delta = 0", table);
  EXPECT_LT(errors.back(), 6e-5); // the trace space's own error; the fields of t and t - dt differ by 1e-3
}
