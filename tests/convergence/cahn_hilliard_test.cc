// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>

#include <deal.II/base/convergence_table.h>

#include <gtest/gtest.h>
#include <iostream>

#include "support/phase_field_run.h"

using namespace Gemmule;
using namespace Gemmule::Testing;

namespace
{
MembraneModel make_model(const double cahn, const double contrast, const double mach = 1.)
{
  Parameters::Membrane membrane;
  membrane.cahn_number = cahn;
  membrane.surface_energy_contrast = contrast;
  membrane.mach_number = mach;
  membrane.peclet_number = 2.;
  return MembraneModel(membrane, {});
}

double one(const Point<2> &)
{
  return 1.;
}
double angle(const Point<2> &x)
{
  return std::atan2(x[1], x[0]);
}

/** Relative growth rate of cos(k theta) about c = 1/2 on a circle at rest, from amplitudes after backward
 * Euler's start. */
double measured_rate(const MembraneModel &model, const unsigned int k, const double radius,
                     const unsigned int level, const unsigned int n_steps)
{
  PhaseFieldRun run(level, model, EllipseDistance({}, radius, radius));
  const auto mode = [k](const Point<2> &x) { return std::cos(k * angle(x)); };
  run.initialise([&](const Point<2> &x) { return 0.5 + 1e-5 * mode(x); }, one);
  const auto amplitude = [&]
  {
    return run.harness.integrate(run.solver.concentration(),
                                 [&](const double f, const Point<2> &x) { return (f - 0.5) * mode(x); });
  };
  const double dt = 0.2 / n_steps;
  run.advance(dt);
  const double start = amplitude();
  for (unsigned int n = 1; n < n_steps; ++n)
    run.advance(dt);
  return std::log(amplitude() / start) / (dt * (n_steps - 1));
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

/** Equilibrium profile with boundaries at the top and the bottom of a circle about @p centre. */
double profile(const Point<2> &x, const double radius, const double cahn)
{
  const double distance = radius * (0.5 * numbers::PI - std::abs(angle(x)));
  return 0.5 * (1. + std::tanh(distance / (2. * std::sqrt(2.) * cahn)));
}
} // namespace

TEST(CahnHilliard, LinearGrowthRatesAreThoseOfTheory)
{
  const double radius = 0.5, cahn = 0.1, x = 0.2, mach = 1.5;
  const auto model = make_model(cahn, x, mach);
  for (const unsigned int k : {1, 2, 3})
  {
    const double wave = k * k / (radius * radius);
    const double theory = -wave / 2. * (-0.25 + mach * x * x * std::exp(-x / 2.) + cahn * cahn * wave);
    const double measured = measured_rate(model, k, radius, 5, 40);
    std::cout << "mode " << k << ": growth rate " << measured << ", theory " << theory << '\n';
    EXPECT_NEAR(measured, theory, 4e-3 * std::abs(theory));
  }
}

TEST(CahnHilliard, GrowthIsOfSecondOrderInTime)
{
  const double radius = 0.5, cahn = 0.1;
  const auto model = make_model(cahn, 0.);
  const double wave = 9. / (radius * radius);
  const double theory = -wave / 2. * (-0.25 + cahn * cahn * wave);
  ConvergenceTable table;
  std::vector<double> errors;
  for (const unsigned int n_steps : {10, 20, 40})
  {
    errors.push_back(std::abs(measured_rate(model, 3, radius, 6, n_steps) - theory));
    table.add_value("steps", n_steps);
    table.add_value("error", errors.back());
  }
  print("growth rate of mode 3", table);
  EXPECT_GT(std::log2(errors[0] / errors[2]) / 2., 1.8);
}

TEST(CahnHilliard, EquilibriumProfileAndItsEnergyConverge)
{
  const double radius = 0.5, cahn = 0.04; // farther boundaries feel each other by 1e-6 only
  const auto model = make_model(cahn, 0.);
  const double energy = 2. * cahn / (6. * std::sqrt(2.));
  ConvergenceTable table;
  std::vector<double> errors, energy_errors;
  for (const unsigned int level : {4, 5, 6})
  {
    PhaseFieldRun run(level, model, EllipseDistance({}, radius, radius));
    const auto exact = [&](const Point<2> &x) { return profile(x, radius, cahn); };
    run.initialise(exact, one);
    for (unsigned int n = 0; n < 10; ++n)
      run.advance(0.2);
    errors.push_back(run.harness.l2_error(run.solver.concentration(), exact));
    energy_errors.push_back(std::abs(run.solver.diagnostics().energy_phase - energy));
    table.add_value("cells per unit length", 1u << (level - 1));
    table.add_value("error", errors.back());
    table.add_value("energy error", energy_errors.back());
    table.add_value("phase dissipation", run.solver.diagnostics().dissipation_phase);
  }
  table.set_scientific("energy error", true);
  table.set_scientific("phase dissipation", true);
  table.evaluate_convergence_rates("energy error", ConvergenceTable::reduction_rate_log2);
  print("equilibrium profile, C = 0.04", table);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 2.5);
  EXPECT_LT(energy_errors.back(), 1e-3 * energy);
  EXPECT_GT(std::log2(energy_errors[1] / energy_errors[2]), 2.5);
}

// The profile is carried along unchanged by a translation.
TEST(CahnHilliard, TranslatedEquilibriumProfileConverges)
{
  const double radius = 0.5, cahn = 0.05;
  const auto model = make_model(cahn, 0.);
  const Tensor<1, 2> u = Point<2>(0.1, 0.06);
  ConvergenceTable table;
  std::vector<double> errors;
  for (const unsigned int level : {4, 5, 6})
  {
    PhaseFieldRun run(
        level, model, [&](const double t) { return EllipseDistance(Point<2>() + t * u, radius, radius); },
        [&](const Point<2> &) { return u; });
    run.initialise([&](const Point<2> &x) { return profile(x, radius, cahn); }, one);
    const unsigned int n_steps = 5u << (level - 4) << (level - 4);
    for (unsigned int n = 0; n < n_steps; ++n)
      run.advance(0.4 / n_steps);
    errors.push_back(run.harness.l2_error(run.solver.concentration(), [&](const Point<2> &x)
                                          { return profile(x - 0.4 * u, radius, cahn); }));
    table.add_value("cells per unit length", 1u << (level - 1));
    table.add_value("steps", n_steps);
    table.add_value("error", errors.back());
  }
  print("translated equilibrium profile, C = 0.05", table);
  EXPECT_GT(std::log2(errors[0] / errors[2]) / 2., 2.5);
}

TEST(CahnHilliard, NewtonThatDoesNotConvergeSaysSo)
{
  const auto model = make_model(0.05, 0.);
  PhaseFieldRun run(4, model, EllipseDistance({}, 0.5, 0.5));
  run.parameters.newton_maximum_iterations = 1;
  run.initialise([](const Point<2> &x) { return 0.5 + 0.4 * std::sin(5. * x[0]); }, one);
  try
  {
    run.advance(0.1);
    FAIL() << "expected SimulationError";
  }
  catch (const SimulationError &error)
  {
    EXPECT_NE(std::string(error.what()).find("1 iterations"), std::string::npos) << error.what();
  }
}
