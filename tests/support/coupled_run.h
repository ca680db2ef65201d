// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/application/reporting.h>
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/time/step_control.h>

namespace Gemmule::Testing
{
/** A case on a mesh so small that a step takes a few hundredths of a second; steps of a given size. */
inline AllParameters small_case()
{
  AllParameters parameters;
  parameters.mesh.bulk_level = 3;
  parameters.mesh.membrane_level = 5;
  parameters.mesh.phase_boundary_level = 5;
  return parameters;
}

/** The same with a prescribed tension in place of the phases. */
inline AllParameters small_case_with_tension(const std::string &tension)
{
  AllParameters parameters = small_case();
  parameters.membrane.tension_model = Parameters::TensionModel::prescribed;
  parameters.membrane.prescribed_tension = tension;
  return parameters;
}

/**
 * Two phases that are separated from the start, with boundaries where @p expression vanishes (a distance),
 * and so wide (Cahn number 0.05) that the small meshes resolve them.
 */
inline void set_two_phases(AllParameters &parameters, const std::string &expression)
{
  parameters.membrane.cahn_number = 0.05;
  parameters.membrane.initial_concentration = "0.5+0.45*tanh((" + expression + ")/0.1414)";
}

inline StatisticsRow statistics_of(const CoupledSystem<2> &system)
{
  return make_statistics(system, sample_membrane(system));
}

/**
 * Makes @p n_steps steps of size @p dt, all accepted, and returns the statistics of all states, the initial
 * one included.
 */
inline std::vector<StatisticsRow> run_steps(CoupledSystem<2> &system, const unsigned int n_steps,
                                            const double dt)
{
  std::vector<StatisticsRow> rows{statistics_of(system)};
  for (unsigned int i = 0; i < n_steps; ++i)
  {
    system.try_step(dt);
    system.accept();
    rows.push_back(statistics_of(system));
  }
  return rows;
}

inline std::vector<StatisticsRow> run_case(const AllParameters &parameters, const unsigned int n_steps,
                                           const double dt)
{
  CoupledSystem<2> system(parameters, MPI_COMM_WORLD);
  system.initialise();
  return run_steps(system, n_steps, dt);
}

/** The same with the steps that the step control chooses. */
inline std::vector<StatisticsRow> run_with_step_control(const AllParameters &parameters, const double end)
{
  CoupledSystem<2> system(parameters, MPI_COMM_WORLD);
  system.initialise();
  StepControl control(parameters.time_stepping, 0., {end});
  std::vector<StatisticsRow> rows{statistics_of(system)};
  while (!control.finished())
  {
    const auto errors = system.try_step(control.propose(system.time_step_limits().longest_step(1.)));
    if (!control.judge(std::max(errors.shape, errors.composition) / parameters.time_stepping.tolerance))
      continue;
    system.accept();
    rows.push_back(statistics_of(system));
  }
  return rows;
}

/** Largest relative change over a run of one figure of the statistics. */
inline double largest_drift(const std::vector<StatisticsRow> &rows, double StatisticsRow::*figure)
{
  double drift = 0.;
  for (const auto &row : rows)
    drift = std::max(drift, std::abs(row.*figure / (rows.front().*figure) - 1.));
  return drift;
}
} // namespace Gemmule::Testing
