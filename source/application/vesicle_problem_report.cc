// SPDX-License-Identifier: LGPL-2.1-or-later
// What VesicleProblem writes of the steps it has made.
#include <gemmule/application/checkpoints.h>
#include <gemmule/application/run_results.h>
#include <gemmule/application/step_attempts.h>
#include <gemmule/application/vesicle_problem.h>
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/output/disk_error.h>
#include <gemmule/output/run_log.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Gemmule
{
using namespace dealii;

template <int dim>
void VesicleProblem<dim>::write_results()
{
  try
  {
    report();
    results->write_if_due(*system);
    if (control.finished() || checkpoints->is_due(results->row().step))
      write_checkpoint();
    log->check();
  }
  catch (const DiskError &)
  {
    throw; // the log gets it with the advice
  }
  catch (const SimulationError &error)
  {
    log_end(error.what());
    throw;
  }
}

template <int dim>
void VesicleProblem<dim>::report()
{
  results->report(*system, attempts->errors(), wall_time());
  warn_of_negative_tension();
  if (const auto solver = system->get_flow().linear_solver_report(); !solver.warning.empty())
    log->warn_once("solver of the flow", solver.warning);
  if (system->lowered_levels() > 0)
    log->warn_once("too many cells", "the mesh needs more than 'Mesh/Largest number of cells' = " +
                                         std::to_string(parameters.mesh.largest_number_of_cells) +
                                         " cells; the finest level is lowered.");
}

template <int dim>
void VesicleProblem<dim>::warn_of_negative_tension()
{
  const StatisticsRow &row = results->row();
  // With enough bending rigidity the wrinkles have a wavelength of their own.
  if (row.tension_min >= 0.)
    return;
  const std::string since =
      "the tension is negative on a part of the membrane since t = " + rounded(row.time) + " (minimum " +
      rounded(row.tension_min) + "), and ";
  if (row.grid_scale_rigidity > 0.)
    log->warn_once("negative tension",
                   since +
                       "its bending rigidity is too small for the mesh: a numerical one ('Membrane/Bending/"
                       "Grid-scale rigidity') makes the fastest wrinkles " +
                       rounded(2. * numbers::PI * std::sqrt(3. * parameters.bending.grid_scale_rigidity)) +
                       " cells long. What depends on them depends on the mesh (doc/model.md).");
  else if (system->get_bending() == nullptr && system->grid_scale_rigidity() == 0.)
    log->warn_once(
        "negative tension",
        since + "there is no bending rigidity: short waves of the shape grow at the rate |sigma| k / 4, "
                "and wrinkles get the wavelength of the mesh (doc/model.md).");
}

template <int dim>
void VesicleProblem<dim>::print_timers()
{
  std::ostringstream text;
  text << "finished: t = " << results->row().time << ", " << results->row().step << " steps, "
       << retries.memory().n_rejected << " rejected, " << (is_resumed ? "since it was resumed " : "")
       << rounded(wall_clock.cpu_time()) << " s CPU (" << rounded(wall_clock.wall_time()) << " s wall clock)";
  log->info(text.str());
  log->info("  the mesh has changed " + std::to_string(system->mesh_changes()) + " times; " +
            std::to_string(system->mesh().n_global_active_cells()) + " cells at the end");
  const auto cpu = system->timer().get_summary_data(TimerOutput::total_cpu_time);
  const double total = std::max(wall_clock.cpu_time(), 1e-6);
  for (const auto &[section, seconds] : cpu)
    log->info("  " + section + ": " + rounded(seconds) + " s CPU, " + rounded(100. * seconds / total) + " %");
}

template void VesicleProblem<2>::report();
template void VesicleProblem<2>::write_results();
template void VesicleProblem<2>::print_timers();
} // namespace Gemmule
