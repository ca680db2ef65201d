// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>
#include <iostream>

#include "support/phase_field_run.h"

using namespace Gemmule;
using namespace Gemmule::Testing;

namespace
{
double initial_concentration(const Point<2> &x)
{
  return 0.5 + 0.2 * std::sin(7. * x[0]) * std::cos(5. * x[1]);
}
double initial_total(const Point<2> &x)
{
  return 1. + 0.1 * std::cos(3. * x[0] + x[1]);
}

MembraneModel make_model(const Parameters::RegularisationModel choice)
{
  Parameters::Membrane membrane;
  membrane.cahn_number = 0.05;
  Parameters::Regularisation regularisation;
  regularisation.model = choice;
  regularisation.diffusion_coefficient = 0.01;
  return MembraneModel(membrane, regularisation);
}
} // namespace

TEST(ParallelSurfaceInvariants, MassIsExactOnAMovingMembraneWithChangingMeshes)
{
  for (const auto choice :
       {Parameters::RegularisationModel::none, Parameters::RegularisationModel::diffusion})
  {
    const auto model = make_model(choice);
    PhaseFieldRun run(
        4, model,
        [](const double t) {
          return EllipseDistance({0.01, 0.02}, 0.5 * std::exp(t), 0.5 * std::exp(-t));
        },
        [](const Point<2> &x) { return Tensor<1, 2>(Point<2>(x[0] - 0.01, -(x[1] - 0.02))); });
    // two levels meet on the membrane
    run.refine_where([](const Point<2> &x) { return x[0] > 0.; });
    run.initialise(initial_concentration, initial_total);
    const double mass_f = run.solver.diagnostics().mass_f, mass_total = run.solver.diagnostics().mass_total;
    for (unsigned int n = 0; n < 12; ++n)
    {
      run.advance(n % 3 == 0 ? 0.01 : 0.015);
      EXPECT_NEAR(run.solver.diagnostics().mass_f, mass_f, 1e-12 * mass_f);
      EXPECT_NEAR(run.solver.diagnostics().mass_total, mass_total, 1e-12 * mass_total);
      if (n % 4 == 3) // refine and coarsen cut cells between steps
        run.refine_where(
            [n](const Point<2> &x) { return (n % 8 == 3 ? x[1] : -x[1]) > 0.1 && x.norm() < 0.8; }, true);
    }
  }
}

// A step that takes the membrane past several cells leaves no unconnected parts of the band.
TEST(ParallelSurfaceInvariants, MassIsExactWhenTheMembraneJumpsOverCells)
{
  const auto model = make_model(Parameters::RegularisationModel::none);
  const Tensor<1, 2> u = Point<2>(1., 0.4);
  PhaseFieldRun run(
      5, model, [&](const double t) { return EllipseDistance(Point<2>(-0.2, 0.) + t * u, 0.4, 0.4); },
      [&](const Point<2> &) { return u; });
  run.initialise(initial_concentration, initial_total);
  const double mass_f = run.solver.diagnostics().mass_f, mass_total = run.solver.diagnostics().mass_total;
  for (unsigned int n = 0; n < 2; ++n)
  {
    run.advance(0.15);
    EXPECT_NEAR(run.solver.diagnostics().mass_f, mass_f, 1e-12);
    EXPECT_NEAR(run.solver.diagnostics().mass_total, mass_total, 1e-12);
  }
}

TEST(SurfaceInvariants, EnergyDoesNotIncreaseOnAMembraneAtRest)
{
  const auto model = make_model(Parameters::RegularisationModel::none);
  PhaseFieldRun run(5, model, EllipseDistance({}, 0.6, 0.4));
  run.initialise(initial_concentration, [](const Point<2> &) { return 1.; });
  const auto energy = [&]
  { return run.solver.diagnostics().energy_phase + run.solver.diagnostics().energy_surface; };
  double last = energy();
  const double start = last;
  double dissipated = 0., last_dissipation = run.solver.diagnostics().dissipation_phase;
  double start_of_balance = 0.;
  for (unsigned int n = 0; n < 60; ++n)
  {
    const double dt = 0.005;
    run.advance(dt);
    EXPECT_LE(energy(), last + 1e-12) << "step " << n;
    last = energy();
    const double dissipation = run.solver.diagnostics().dissipation_phase;
    if (n >= 10)
      dissipated += 0.5 * dt * (dissipation + last_dissipation);
    if (n == 9)
      start_of_balance = last;
    last_dissipation = dissipation;
  }
  std::cout << "energy " << start << " -> " << last << ", balance " << (start_of_balance - last) / dissipated
            << '\n';
  EXPECT_LT(last, start - 1e-3);
  EXPECT_NEAR((start_of_balance - last) / dissipated, 1., 0.02);
}

// The result does not depend on the number of ranks: figures of one rank. The membrane passes through no
// vertex of the mesh, where round-off would decide which cells it cuts.
TEST(ParallelSurfaceInvariants, ResultIsThatOfOneRank)
{
  const auto model = make_model(Parameters::RegularisationModel::compressibility);
  PhaseFieldRun run(
      4, model,
      [](const double t) {
        return EllipseDistance({0.013, 0.027}, 0.51 * std::exp(t), 0.51 * std::exp(-t));
      },
      [](const Point<2> &x) { return Tensor<1, 2>(Point<2>(x[0] - 0.013, -(x[1] - 0.027))); });
  run.refine_where([](const Point<2> &x) { return x[0] > 0.; });
  run.initialise(initial_concentration, initial_total);
  for (unsigned int n = 0; n < 5; ++n)
    run.advance(0.02);
  const auto &figures = run.solver.diagnostics();
  double tension = 0.;
  const auto sigma = run.solver.tension();
  for (unsigned int k = 0; k < sigma.size(); ++k)
    for (unsigned int q = 0; q < sigma[k].size(); ++q)
      tension += run.harness.geometry.cut_cells()[k].surface_weights[q] * sigma[k][q];
  tension = Utilities::MPI::sum(tension, MPI_COMM_WORLD);
  EXPECT_EQ(run.solver.n_unknowns(), 1014u);
  EXPECT_NEAR(figures.energy_phase, 0.048709560372253, 1e-11);
  EXPECT_NEAR(figures.energy_surface, 2.950189367873, 1e-11);
  EXPECT_NEAR(figures.dissipation_phase, 0.0095177400676063, 1e-11);
  EXPECT_NEAR(tension, 2.7329887553522, 1e-11);
}
