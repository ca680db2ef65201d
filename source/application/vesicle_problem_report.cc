// SPDX-License-Identifier: LGPL-2.1-or-later
// What VesicleProblem writes of the steps it has made.
#include <gemmule/application/checkpoints.h>
#include <gemmule/application/reporting.h>
#include <gemmule/application/vesicle_problem.h>
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/output/disk_error.h>
#include <gemmule/output/run_log.h>
#include <gemmule/time/step_control.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace Gemmule
{
using namespace dealii;

namespace
{
  /** Is @p time (hit exactly by the step control) one of the multiples of @p interval, or a listed time? */
  bool is_due(const double time, const double interval, const std::vector<double> &times)
  {
    const auto same = [time](const double other)
    { return std::abs(time - other) <= 1e-9 * std::max(1., other); };
    return (interval > 0. && same(interval * std::round(time / interval))) ||
           std::any_of(times.begin(), times.end(), same);
  }
} // namespace

template <int dim>
void VesicleProblem<dim>::write_results()
{
  try
  {
    report();
    write_output_if_due(control->finished());
    if (control->finished() || checkpoints->is_due(row.step))
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
  previous_row = row;
  membrane_is_written = false;
  *membrane = sample_membrane(*system);
  row = make_statistics(*system, *membrane);
  row.step = row.time > 0. ? previous_row.step + 1 : 0;
  row.time_step_size = row.time - previous_row.time;
  row.wall_time = earlier_wall_time + wall_clock.wall_time();
  row.time_error_shape = error_shape;
  row.time_error_composition = error_composition;
  if (row.step > 0)
  {
    const auto dissipation = [](const StatisticsRow &r)
    { return r.dissipation_viscous + r.dissipation_phase; };
    const double dissipated = 0.5 * row.time_step_size * (dissipation(row) + dissipation(previous_row));
    row.energy_balance_error =
        (row.energy_total - previous_row.energy_total + dissipated) / std::max(dissipated, 1e-300);
  }
  statistics->write(row);

  warn_of_negative_tension();
  if (system->lowered_levels() > 0)
    log->warn_once("too many cells", "the mesh needs more than 'Mesh/Largest number of cells' = " +
                                         std::to_string(parameters.mesh.largest_number_of_cells) +
                                         " cells; the finest level is lowered.");
}

template <int dim>
void VesicleProblem<dim>::warn_of_negative_tension()
{
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
  else if (system->get_bending() == nullptr && system->get_model().bending().grid_scale_rigidity() == 0.)
    log->warn_once(
        "negative tension",
        since + "there is no bending rigidity: short waves of the shape grow at the rate |sigma| k / 4, "
                "and wrinkles get the wavelength of the mesh (doc/model.md).");
}

template <int dim>
void VesicleProblem<dim>::write_output_if_due(const bool at_end)
{
  const auto &output = parameters.output;
  if (is_due(row.time, output.interface_interval, output.output_times) || at_end)
  {
    interface_writer->write(*membrane);
    membrane_is_written = true;
  }
  if (is_due(row.time, output.field_interval, output.output_times) || (at_end && output.field_interval > 0.))
    write_fields(*system, row.time, *field_writer);
}

template <int dim>
void VesicleProblem<dim>::print_timers()
{
  std::ostringstream text;
  text << "finished: t = " << row.time << ", " << row.step << " steps, " << n_rejected << " rejected, "
       << (is_resumed ? "since it was resumed " : "") << rounded(wall_clock.cpu_time()) << " s CPU ("
       << rounded(wall_clock.wall_time()) << " s wall clock)";
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
template void VesicleProblem<2>::write_output_if_due(bool);
template void VesicleProblem<2>::print_timers();
} // namespace Gemmule
