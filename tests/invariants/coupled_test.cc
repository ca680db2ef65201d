// SPDX-License-Identifier: LGPL-2.1-or-later
// The whole time step: benchmarks with known answers, what the model conserves, its symmetries.
#include <cmath>
#include <gtest/gtest.h>

#include "support/coupled_run.h"

using namespace Gemmule;
using namespace Gemmule::Testing;
using Parameters::ArclengthModel;
using Parameters::RegularisationModel;

namespace
{
using Rows = std::vector<StatisticsRow>;

/** Dissipation of a row of the statistics. */
double dissipation(const StatisticsRow &row)
{
  return row.dissipation_viscous + row.dissipation_phase;
}

/** Energy at the end plus what was dissipated since @p start (trapezoidal rule) minus energy then. */
double balance_error(const Rows &rows, const double start = 0.)
{
  double sum = 0.;
  for (unsigned int i = 1; i < rows.size(); ++i)
    if (rows[i - 1].time > start - 1e-12)
      sum += rows[i].energy_total - rows[i - 1].energy_total +
             0.5 * (rows[i].time - rows[i - 1].time) * (dissipation(rows[i]) + dissipation(rows[i - 1]));
  return sum;
}
} // namespace

TEST(ParallelCoupled, EllipseUnderConstantTensionRelaxesAsTheBoundaryIntegralSolution)
{
  const auto rows = run_case(small_case_with_tension("1"), 20, 0.01);
  const double truth = 0.14922748; // boundary-integral solution
  EXPECT_NEAR(rows.back().time, 0.2, 1e-12);
  EXPECT_NEAR(rows.back().deformation / truth, 1., 2e-3);
  EXPECT_LT(largest_drift(rows, &StatisticsRow::area), 1e-10);
  for (unsigned int i = 1; i < rows.size(); ++i)
    EXPECT_LT(rows[i].deformation, rows[i - 1].deformation) << "step " << i;
}

class ParallelConservation : public testing::TestWithParam<RegularisationModel>
{
};

TEST_P(ParallelConservation, MassesAndAreaAlsoThroughRemeshings)
{
  // The membrane shears through the mesh, and phase boundaries are finer than the rest of it.
  AllParameters parameters = small_case();
  set_two_phases(parameters, "x-0.1");
  parameters.membrane.initial_total_concentration = "1+0.1*y";
  parameters.regularisation.model = GetParam();
  parameters.domain.boundary_velocity = "2*y; 0";
  parameters.mesh.membrane_level = 4;
  parameters.mesh.phase_boundary_level = 5;
  parameters.mesh.membrane_layers = 1;
  parameters.mesh.remeshing_interval = 1;
  CoupledSystem<2> system(parameters, MPI_COMM_WORLD);
  system.initialise();
  unsigned int n_changes = 0;
  Rows rows{statistics_of(system)};
  // Steps of different sizes, one of them rejected, as the step control makes them.
  for (const double dt : {0.005, 0.007, 0.01, 0.008, 0.01, 0.012, 0.01, 0.01})
  {
    if (rows.size() == 4)
      system.try_step(0.015);
    system.try_step(dt);
    system.accept();
    rows.push_back(statistics_of(system));
    n_changes += rows.back().cells != rows[rows.size() - 2].cells;
  }
  EXPECT_GE(n_changes, 2u) << "the mesh has to change for this test to mean anything";
  for (const auto &row : rows)
  {
    EXPECT_NEAR(row.mass_f / rows.front().mass_f, 1., 1e-11) << "t = " << row.time;
    EXPECT_NEAR(row.mass_total / rows.front().mass_total, 1., 1e-11) << "t = " << row.time;
    EXPECT_NEAR(row.area / rows.front().area, 1., 1e-10) << "t = " << row.time;
  }
  // and f is not conserved because nothing happens
  EXPECT_GT(std::abs(rows.back().composition_max - rows.front().composition_max), 1e-3);
}

std::string name_of(const testing::TestParamInfo<RegularisationModel> &info)
{
  constexpr std::array<const char *, 4> names{{"Compressibility", "UpdateSmoothing", "Diffusion", "None"}};
  return names[static_cast<unsigned int>(info.param)];
}

INSTANTIATE_TEST_SUITE_P(ParallelRegularisations, ParallelConservation,
                         testing::Values(RegularisationModel::compressibility,
                                         RegularisationModel::update_smoothing,
                                         RegularisationModel::diffusion, RegularisationModel::none),
                         name_of);

namespace
{
/** Two phases on a membrane that is compressible, which has an energy law. */
AllParameters case_with_energy_law()
{
  AllParameters parameters = small_case();
  set_two_phases(parameters, "x-0.1+0.3*y");
  parameters.mesh.membrane_level = parameters.mesh.phase_boundary_level = 6;
  return parameters;
}
} // namespace

TEST(CoupledEnergy, BalancesTheDissipationToAPerMilleAtDefaultTolerances)
{
  const auto rows = run_with_step_control(case_with_energy_law(), 0.2);
  for (unsigned int i = 1; i < rows.size(); ++i)
    EXPECT_LE(rows[i].energy_total, rows[i - 1].energy_total) << "step " << i;
  const double drop = rows.front().energy_total - rows.back().energy_total;
  EXPECT_GT(drop, 0.01);
  EXPECT_LT(std::abs(balance_error(rows)), 1e-3 * drop); // measured: 4.8e-4
}

TEST(CoupledEnergy, BalanceIsOfSecondOrderInTime)
{
  // After the layer in which the phase boundaries find their profile, whose dissipation no step resolves.
  std::array<double, 2> errors;
  for (const unsigned int i : {0u, 1u})
  {
    AllParameters parameters = case_with_energy_law();
    parameters.time_stepping.adaptive = false;
    parameters.time_stepping.initial_step = 0.02 / (1u << i);
    errors[i] = std::abs(balance_error(run_with_step_control(parameters, 0.2), 0.06));
  }
  EXPECT_LT(errors[1], 0.3 * errors[0]);
}

TEST(CoupledEnergy, BalancesWithPrescribedTensionAndViscosityContrast)
{
  // E = L for tension 1: what the membrane loses in length is dissipated in the fluids.
  for (const double viscosity_ratio : {0.1, 10.})
  {
    AllParameters parameters = small_case_with_tension("1");
    parameters.fluid.viscosity_ratio = viscosity_ratio;
    const auto rows = run_case(parameters, 10, 0.01);
    const double drop = rows.front().energy_total - rows.back().energy_total;
    EXPECT_GT(drop, 1e-3);
    EXPECT_NEAR(rows.front().energy_total, rows.front().arclength, 1e-12);
    EXPECT_LT(std::abs(balance_error(rows)), 0.01 * drop);
  }
}

TEST(CoupledArclength, PenaltyIsStableAtLargeStepsHoweverStiff)
{
  // Explicitly, a penalty of 1e6 would need steps of 1e-7. Measured: |L - L0|/L0 is 0.40 % with 100, which
  // the tension near zero asks for, and goes down as the inverse of the penalty.
  std::array<Rows, 2> runs;
  for (const unsigned int strong : {0u, 1u})
  {
    AllParameters parameters = small_case();
    set_two_phases(parameters, "x-0.1");
    parameters.membrane.level_set = "x^2+8*y^2-0.25";
    parameters.arclength.model = ArclengthModel::penalty;
    parameters.arclength.penalty = strong ? 1e6 : 100.;
    parameters.bending.grid_scale_rigidity = 0.; // no part of the energy
    Rows &rows = runs[strong];
    rows = run_case(parameters, 20, 0.01);
    for (unsigned int i = 1; i < rows.size(); ++i)
    {
      EXPECT_LT(rows[i].energy_total, rows[i - 1].energy_total) << "step " << i;
      EXPECT_LT(rows[i].max_velocity, 0.1) << "step " << i;
    }
    EXPECT_LT(rows.back().max_velocity, 0.02);
    // The membrane would shorten, so that the constraint takes the tension down to about zero.
    EXPECT_LT(rows.back().tension_min, -0.02);
    EXPECT_GT(rows.back().tension_min, -0.15);
    EXPECT_LT(rows.back().tension_max, 0.15);
  }
  EXPECT_LT(runs[0].back().arclength, runs[0].front().arclength);
  EXPECT_NEAR(largest_drift(runs[0], &StatisticsRow::arclength), 0.004, 0.001);
  EXPECT_LT(largest_drift(runs[1], &StatisticsRow::arclength), 5e-6);
  EXPECT_NEAR(runs[1].back().tension_min, runs[0].back().tension_min, 0.01);
}
