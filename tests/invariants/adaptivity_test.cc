// SPDX-License-Identifier: LGPL-2.1-or-later
// What refinement meets in a run: walls and other membranes that are near, phase boundaries across levels,
// and many remeshings in a row.
#include <deal.II/base/mpi.h>

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <iostream>

#include "support/coupled_run.h"
#include "support/test_size.h"

using namespace Gemmule;
using namespace Gemmule::Testing;

namespace
{
using Rows = std::vector<StatisticsRow>;

/** A coarse case, where walls and other membranes are nearer than its cells. */
AllParameters coarse_case_with_tension(const std::string &level_set)
{
  AllParameters parameters = small_case_with_tension("1");
  parameters.membrane.level_set = level_set;
  parameters.mesh.bulk_level = 2;
  parameters.mesh.membrane_level = 4;
  parameters.mesh.phase_boundary_level = 4;
  parameters.mesh.finest_level = 8;
  return parameters;
}

/** Sizes of the cut cells in a part of the box: the smallest and the largest on all ranks. */
std::pair<double, double> cut_cell_sizes(const CoupledSystem<2> &system,
                                         const std::function<bool(const dealii::Point<2> &)> &chosen)
{
  double smallest = 1e10, largest = 0.;
  for (const auto &cell : system.get_geometry().cut_cells())
    if (chosen(cell.physical(dealii::Point<2>(0.5, 0.5))))
    {
      smallest = std::min(smallest, cell.size);
      largest = std::max(largest, cell.size);
    }
  return {dealii::Utilities::MPI::min(smallest, MPI_COMM_WORLD),
          dealii::Utilities::MPI::max(largest, MPI_COMM_WORLD)};
}
} // namespace

TEST(ParallelAdaptivity, MembraneCloserToTheWallThanACoarseCell)
{
  // A circle at rest: whatever moves is an error. The cells of the membrane's level are 0.125 large.
  const double distance = 0.04;
  AllParameters parameters = coarse_case_with_tension("sqrt((x-0.66)^2+y^2)-0.3");
  CoupledSystem<2> system(parameters, MPI_COMM_WORLD);
  system.initialise();
  const auto near = cut_cell_sizes(system, [](const auto &p) { return p[0] > 0.95; });
  EXPECT_LE(near.second, distance / parameters.mesh.cells_per_gap);
  const auto far = cut_cell_sizes(system, [](const auto &p) { return p[0] < 0.6; });
  EXPECT_EQ(far.second, 0.125) << "only what is near the wall is refined";
  const Rows rows = run_steps(system, 6, 0.01);
  EXPECT_LT(largest_drift(rows, &StatisticsRow::area), 1e-10);
  EXPECT_LT(largest_drift(rows, &StatisticsRow::arclength), 1e-4);
  for (const auto &row : rows)
    EXPECT_LT(row.max_velocity, 2e-3);
}

TEST(ParallelAdaptivity, WithoutTheGapCriterionTheWallStillHasWholeCells)
{
  AllParameters parameters = coarse_case_with_tension("sqrt((x-0.67)^2+y^2)-0.3");
  parameters.mesh.cells_per_gap = 0.;
  CoupledSystem<2> system(parameters, MPI_COMM_WORLD);
  system.initialise();
  const auto near = cut_cell_sizes(system, [](const auto &p) { return p[0] > 0.94; });
  EXPECT_LE(near.second, 0.03);
  const Rows rows = run_steps(system, 2, 0.01);
  EXPECT_LT(largest_drift(rows, &StatisticsRow::area), 1e-10);
}

TEST(ParallelAdaptivity, TwoVesiclesNearEachOther)
{
  const double distance = 0.04;
  AllParameters parameters = coarse_case_with_tension("min(sqrt((x+0.32)^2+y^2),sqrt((x-0.32)^2+y^2))-0.3");
  CoupledSystem<2> system(parameters, MPI_COMM_WORLD);
  system.initialise();
  const auto between =
      cut_cell_sizes(system, [](const auto &p) { return std::abs(p[0]) < 0.03 && std::abs(p[1]) < 0.05; });
  EXPECT_LE(between.second, distance / parameters.mesh.cells_per_gap);
  const auto far = cut_cell_sizes(system, [](const auto &p) { return std::abs(p[0]) > 0.4; });
  EXPECT_GE(far.second, 0.0625);
  const Rows rows = run_steps(system, 6, 0.01);
  EXPECT_EQ(rows.front().components, 2u);
  EXPECT_EQ(rows.back().components, 2u);
  EXPECT_LT(largest_drift(rows, &StatisticsRow::area), 1e-10);
  EXPECT_LT(largest_drift(rows, &StatisticsRow::arclength), 1e-4);
  for (const auto &row : rows)
    EXPECT_LT(row.max_velocity, 2e-3);
}

TEST(ParallelAdaptivity, PhaseBoundaryAcrossCellsOfDifferentLevels)
{
  // The flow sweeps the phase boundaries along the membrane, over cells of three levels. With the default
  // regularisation the energy does not grow in a fluid that rotates with its walls.
  AllParameters parameters = small_case();
  set_two_phases(parameters, "x-0.1");
  parameters.membrane.level_set = "sqrt(x^2+y^2)-0.45";
  parameters.domain.boundary_velocity = "-4*y; 4*x";
  parameters.mesh.bulk_level = 2;
  parameters.mesh.membrane_level = 3;
  parameters.mesh.phase_boundary_level = 3;
  parameters.mesh.cells_per_phase_boundary = 5.; // 0.31 / 5: level 6
  parameters.mesh.composition_lower = 0.1;       // the phases have 0.05 and 0.95
  parameters.mesh.composition_upper = 0.9;
  parameters.mesh.membrane_layers = 1;
  parameters.mesh.remeshing_interval = 1;
  parameters.mesh.cells_per_gap = parameters.mesh.curvature_tolerance = 0.;
  CoupledSystem<2> system(parameters, MPI_COMM_WORLD);
  system.initialise();
  const auto sizes = cut_cell_sizes(system, [](const auto &) { return true; });
  EXPECT_EQ(sizes.first, std::ldexp(2., -6));
  EXPECT_GE(sizes.second, 4. * sizes.first);
  const Rows rows = run_steps(system, 12, 0.01);
  EXPECT_GT(system.mesh_changes(), 4u);
  EXPECT_LT(largest_drift(rows, &StatisticsRow::mass_f), 1e-11);
  EXPECT_LT(largest_drift(rows, &StatisticsRow::mass_total), 1e-11);
  EXPECT_LT(largest_drift(rows, &StatisticsRow::area), 1e-10);
  for (unsigned int i = 1; i < rows.size(); ++i)
    EXPECT_LT(rows[i].energy_total, rows[i - 1].energy_total + 1e-6) << "step " << i;

  // Nor does it matter that the cells are refined only when the boundaries get there.
  parameters.mesh.membrane_level = parameters.mesh.phase_boundary_level = 6;
  CoupledSystem<2> fine(parameters, MPI_COMM_WORLD);
  fine.initialise();
  const Rows reference = run_steps(fine, 12, 0.01);
  EXPECT_NEAR(rows.back().f_total_min, reference.back().f_total_min, 1e-3);
  EXPECT_NEAR(rows.back().f_total_max, reference.back().f_total_max, 1e-3);
  EXPECT_NEAR(rows.back().energy_total / reference.back().energy_total, 1., 1e-3);
}

namespace
{
/**
 * A vesicle with two phases that a uniform stream carries to and fro, by about a cell in each step, to have
 * another mesh in almost every step; for n_steps, or until the mesh has changed most_changes times.
 */
Rows carried_to_and_fro(AllParameters parameters, const unsigned int most_changes, unsigned int &n_steps,
                        unsigned int &mesh_changes)
{
  set_two_phases(parameters, "x-0.05");
  parameters.membrane.cahn_number = 0.1;
  parameters.membrane.level_set = "x^2+1.3*y^2-0.2";
  parameters.domain.boundary_velocity = "12*cos(40*t); 0";
  CoupledSystem<2> system(parameters, MPI_COMM_WORLD);
  system.initialise();
  Rows rows{statistics_of(system)};
  for (unsigned int i = 0; i < n_steps && system.mesh_changes() < most_changes; ++i)
  {
    system.try_step(0.01);
    system.accept();
    rows.push_back(statistics_of(system));
  }
  n_steps = rows.size() - 1;
  mesh_changes = system.mesh_changes();
  return rows;
}
} // namespace

TEST(Adaptivity, TwoHundredRemeshingsChangeNoIntegralAndHardlyTheEnergy)
{
  AllParameters parameters = small_case();
  parameters.mesh.bulk_level = 2;
  parameters.mesh.membrane_level = parameters.mesh.phase_boundary_level = 4;
  parameters.mesh.membrane_layers = 1;
  parameters.mesh.remeshing_interval = 1;
  parameters.mesh.cells_per_gap = parameters.mesh.curvature_tolerance = 0.;
  const unsigned int n_wanted = is_reduced() ? 20 : 200;
  unsigned int n_changes = 0;
  unsigned int n_steps = 450;
  const Rows adaptive = carried_to_and_fro(parameters, n_wanted, n_steps, n_changes);
  EXPECT_GE(n_changes, n_wanted);
  EXPECT_LT(largest_drift(adaptive, &StatisticsRow::mass_f), 1e-11);
  EXPECT_LT(largest_drift(adaptive, &StatisticsRow::mass_total), 1e-11);
  EXPECT_LT(largest_drift(adaptive, &StatisticsRow::area), 1e-10);

  // The same without any change of the mesh: what is left is the difference of the cells far from the
  // membrane.
  parameters.mesh.bulk_level = 4;
  const Rows uniform = carried_to_and_fro(parameters, n_wanted, n_steps, n_changes);
  EXPECT_EQ(n_changes, 0u);
  ASSERT_EQ(uniform.size(), adaptive.size());
  double difference = 0., change = 0.;
  for (unsigned int i = 0; i < uniform.size(); ++i)
  {
    difference = std::max(difference, std::abs(adaptive[i].energy_total - uniform[i].energy_total));
    change = std::max(change, std::abs(uniform[i].energy_total - uniform[0].energy_total));
  }
  std::cout << n_steps << " steps: energies differ by " << difference << ", change by " << change
            << std::endl;
  // Bulk cells of 1/2 instead of 1/8 are a part of that.
  EXPECT_LT(difference, 0.02 * change);
}

TEST(Adaptivity, AChangeOfTheMeshDoesNotChangeTheEnergy)
{
  // From each state of a moving vesicle a step of no size to speak of, on another mesh: with phases of
  // different rigidity and spontaneous curvature, for the energy of bending has second derivatives.
  AllParameters parameters = small_case();
  parameters.mesh.membrane_level = 5;
  parameters.mesh.phase_boundary_level = 6;
  parameters.mesh.membrane_layers = 1;
  parameters.mesh.remeshing_interval = 1;
  set_two_phases(parameters, "x-0.05");
  parameters.membrane.level_set = "x^2+2*y^2-0.2";
  parameters.bending.rigidity_0 = 1e-2;
  parameters.bending.rigidity_1 = 2e-2;
  parameters.bending.spontaneous_curvature_1 = 1.;
  parameters.domain.boundary_velocity = "3*cos(10*t); 0";
  CoupledSystem<2> system(parameters, MPI_COMM_WORLD);
  system.initialise();
  double largest = 0., largest_drop = 0., energy = statistics_of(system).energy_total;
  unsigned int n_changes = 0;
  for (unsigned int i = 0; i < 40; ++i)
  {
    const unsigned int changes_before = system.mesh_changes();
    system.try_step(1e-9);
    if (system.mesh_changes() > changes_before)
    {
      ++n_changes;
      largest = std::max(largest, std::abs(statistics_of(system).energy_total - energy));
    }
    system.try_step(0.01);
    system.accept();
    const double next = statistics_of(system).energy_total;
    largest_drop = std::max(largest_drop, energy - next);
    energy = next;
  }
  std::cout << n_changes << " changes of the mesh change the energy of " << energy << " by at most "
            << largest << "; a step by at most " << largest_drop << std::endl;
  EXPECT_GE(n_changes, 10u);
  EXPECT_LT(largest, 1e-5);
}

TEST(ParallelAdaptivity, ErrorOfTheFlowRefinesTheBulk)
{
  // A stream in and out of the upper wall, away from the membrane.
  AllParameters parameters = small_case_with_tension("1");
  parameters.membrane.level_set = "3*((x+0.4)^2+(y+0.4)^2-0.25^2)";
  parameters.mesh.bulk_level = 3;
  parameters.mesh.membrane_level = parameters.mesh.phase_boundary_level = 4;
  parameters.mesh.finest_level = 6;
  parameters.domain.boundary_velocity = "0; sin(pi*x)*exp(-20*(y-1)^2)";
  const auto cells_at_the_top = [](const CoupledSystem<2> &system)
  {
    unsigned int n = 0;
    for (const auto &cell : system.mesh().active_cell_iterators())
      n += cell->is_locally_owned() && cell->center()[1] > 0.6 && cell->level() > 3;
    return dealii::Utilities::MPI::sum(n, MPI_COMM_WORLD);
  };
  CoupledSystem<2> without(parameters, MPI_COMM_WORLD);
  without.initialise();
  EXPECT_EQ(cells_at_the_top(without), 0u);
  parameters.mesh.flow_error_tolerance = 0.1;
  CoupledSystem<2> with(parameters, MPI_COMM_WORLD);
  with.initialise();
  const unsigned int n_refined = cells_at_the_top(with);
  EXPECT_GT(n_refined, 20u);
  // The run starts from the distance that the phases and the flow belong to, and not from the expression.
  for (const auto &patch : with.state().levels.level_n.patches)
    for (unsigned int i = 0; i < patch.level_set.size(); ++i)
    {
      const dealii::Point<2> x =
          patch.corner + patch.size * dealii::Tensor<1, 2>(TensorLagrange<2, 3>::node(i));
      const double distance = x.distance(dealii::Point<2>(-0.4, -0.4)) - 0.25;
      ASSERT_NEAR(patch.level_set[i], distance, 1e-4);
    }
  run_steps(with, 3, 0.01);
  EXPECT_GE(cells_at_the_top(with), n_refined / 2) << "they are kept as long as the flow needs them";
}
