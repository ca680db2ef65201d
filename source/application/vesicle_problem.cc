#include <gemmule/application/checkpoints.h>
#include <gemmule/application/coupled_system.h>
#include <gemmule/application/reporting.h>
#include <gemmule/application/vesicle_problem.h>
#include <gemmule/output/output_directory.h>
#include <gemmule/output/rank_zero.h>
#include <gemmule/parameters/errors.h>
#include <gemmule/parameters/text.h>
#include <gemmule/time/step_control.h>

#include <cmath>
#include <limits>
#include <optional>
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

  // When a membrane that the mesh does not resolve is repaired: after so many attempts at one step, or when
  // steps are below so many times the smallest.
  constexpr unsigned int attempts_before_repair = 4;
  constexpr double small_steps = 100.;

  std::string rounded(const double x)
  {
    return Parameters::short_number(x, 4);
  }
} // namespace

template <int dim>
VesicleProblem<dim>::VesicleProblem(const AllParameters &parameters_, const MPI_Comm communicator_,
                                    const std::string &command_line_, const bool resume)
    : parameters(parameters_), communicator(communicator_), command_line(command_line_),
      stop_conditions(parameters.checkpoint.wall_time_limit, communicator),
      provenance(command_line, parameters.values())
{
  checkpoints = std::make_unique<Checkpoints<dim>>(parameters, communicator);
  membrane = std::make_unique<InterfaceSamples<dim>>();
  std::vector<std::string> notes;
  std::optional<RunState<dim>> resumed;
  std::unique_ptr<DirectoryLock> lock;
  if (resume)
  {
    // Before anything is read that another run may be changing.
    on_rank_zero(communicator,
                 [&]() { lock = DirectoryLock::acquire_existing(parameters.output_directory); });
    resumed = checkpoints->load(notes);
  }

  // The case first: a mistake in it must not cost the results of an earlier run.
  system = std::make_unique<CoupledSystem<dim>>(parameters, communicator);
  if (resumed)
    system->restore(resumed->system);
  else
    system->initialise();

  control = std::make_unique<StepControl>(parameters.time_stepping, 0., stops());
  open_output(resumed ? &*resumed : nullptr, std::move(lock));
  if (resumed)
    continue_from(*resumed, notes);
}

template <int dim>
void VesicleProblem<dim>::open_output(const RunState<dim> *resumed, std::unique_ptr<DirectoryLock> lock)
{
  const double resume_after_time =
      resumed != nullptr ? resumed->row.time : -std::numeric_limits<double>::infinity();
  directory = std::make_unique<OutputDirectory>(parameters.output_directory, communicator, resumed != nullptr,
                                                std::move(lock));
  if (resumed != nullptr)
    checkpoints->restore_results();
  log = std::make_unique<RunLog>(directory->path(), communicator, resumed != nullptr);
  std::ostringstream values;
  parameters.print(values);
  directory->write_parameters(values.str());
  statistics = std::make_unique<StatisticsWriter>(directory->path(), communicator, resume_after_time);
  interface_writer =
      std::make_unique<InterfaceWriter<dim>>(directory->path(), communicator, provenance, resume_after_time);
  field_writer = std::make_unique<FieldWriter<dim>>(directory->path(), communicator, provenance,
                                                    resumed != nullptr ? resumed->n_field_files : 0);
}

template <int dim>
VesicleProblem<dim>::~VesicleProblem() = default;

template <int dim>
std::vector<double> VesicleProblem<dim>::stops() const
{
  std::vector<double> times{parameters.end_time};
  for (const double interval : {parameters.output.field_interval, parameters.output.interface_interval})
    for (unsigned int i = 1; interval > 0. && i * interval < parameters.end_time * (1. - 1e-9); ++i)
      times.push_back(i * interval);
  for (const double time : parameters.output.output_times)
    if (time > 0. && time < parameters.end_time)
      times.push_back(time);
  // Two intervals meet at times that differ by round-off: keep one of them.
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end(),
                          [](const double a, const double b) { return b - a <= 1e-9 * std::max(1., b); }),
              times.end());
  times.back() = parameters.end_time;
  return times;
}

template <int dim>
void VesicleProblem<dim>::announce() const
{
  const auto &mesh = system->mesh();
  log->info("Gemmule " + program_version() + ", " +
            std::to_string(Utilities::MPI::n_mpi_processes(communicator)) + " process(es): " + command_line);
  for (const auto &[name, value] : provenance.entries())
    log->record(name + (value.find('\n') == std::string::npos ? ": " : ":\n") + value);
  const std::string cells = std::to_string(mesh.n_global_active_cells()) + " cells";
  if (!directory->earlier_run().empty())
    log->warn("the directory held a run that had not finished. Its results are in " +
              directory->earlier_run() + " now, and --resume --output " + directory->earlier_run() +
              " continues it.");
  if (is_resumed)
    log->info("resumed at t = " + rounded(row.time) + " after " + std::to_string(row.step) +
              " steps; results in " + directory->path() + "; " + cells);
  else
    log->info("results in " + directory->path() + "; " + cells + ", " +
              std::to_string(system->get_flow().n_unknowns()) + " unknowns of the flow" +
              (system->get_surface() != nullptr
                   ? ", " + std::to_string(system->get_surface()->n_unknowns()) + " of the phases"
                   : ""));
  if (system->get_surface() != nullptr)
    if (const auto warning = system->get_model().ill_posedness_warning())
      log->warn(*warning);
}

template <int dim>
int VesicleProblem<dim>::run()
{
  announce();
  if (!is_resumed)
  {
    report();
    write_output_if_due(false);
  }

  while (!control->finished())
  {
    if (const std::string reason = make_step(); !reason.empty())
      return stop(reason);
    write_results();
    if (parameters.output.progress)
      log->progress(system->time(), parameters.end_time, row.step, row.time_step_size);
  }
  print_timers();
  return 0;
}

template <int dim>
std::string VesicleProblem<dim>::make_step()
{
  try
  {
    return attempt_step();
  }
  catch (const SimulationError &error)
  {
    const std::string reason = error.what() + end_of_the_model();
    save_last_state(reason);
    throw SimulationError(reason);
  }
  catch (const ParameterError &error)
  {
    // An expression of t that makes no sense any more. All ranks find it together, and no smaller step
    // helps.
    const std::string reason = parameters.located(error).what();
    save_last_state(reason);
    throw SimulationError(reason);
  }
  catch (const std::exception &error)
  {
    // Of what kind it may be, with several ranks it need not have happened on all of them.
    if (Utilities::MPI::n_mpi_processes(communicator) == 1)
      save_last_state(error.what());
    throw;
  }
}

template <int dim>
std::string VesicleProblem<dim>::end_of_the_model() const
{
  // Concentrations are relative to one; the composition f / total loses its meaning long before zero.
  constexpr double vanishing = 0.1;
  if (system->get_surface() == nullptr || row.f_total_min > vanishing)
    return "";
  return " The total concentration has fallen to " + rounded(row.f_total_min) +
         " on a part of the membrane: the model ends where it reaches zero. Choose another "
         "'Membrane/Regularisation "
         "of the total concentration/Model', such as 'compressibility', or a larger coefficient "
         "(doc/model.md).";
}

template <int dim>
bool VesicleProblem<dim>::repair_membrane(const double dt)
{
  const auto &options = parameters.time_stepping;
  if (!parameters.membrane.repair_unresolved_shapes ||
      (n_attempts < attempts_before_repair && dt > small_steps * options.smallest_step))
    return false;
  // What has not helped for an initial step of time will not help.
  if (control->time() < last_repair + options.initial_step || system->membrane_is_resolved())
    return false;
  last_repair = control->time();
  const std::string at = "at t = " + rounded(control->time());
  try
  {
    const RepairReport report = system->repair_membrane();
    log->info("the membrane " + at +
              " has been repaired, and the run begins anew from there: what was thinner than " +
              rounded(2. * report.radius) + " is gone; arclength " +
              Parameters::short_number(report.arclength_before, 8) + " before and " +
              Parameters::short_number(report.arclength_after, 8) + " after.");
  }
  catch (const SimulationError &error)
  {
    log->info("the membrane " + at + " cannot be repaired: " + error.what());
    return false;
  }
  log->warn_once("repair", "steps fail, and the mesh does not resolve the membrane since t = " +
                               rounded(control->time()) +
                               ": it is repaired ('Membrane/Repair unresolved shapes'), by topological "
                               "changes where two sheets share a cell. What follows depends on the mesh; "
                               "bending rigidity or a finer mesh may avoid it.");
  control->restart();
  n_attempts = 0;
  return true;
}

template <int dim>
std::string VesicleProblem<dim>::attempt_step()
{
  const auto &options = parameters.time_stepping;
  while (true)
  {
    // Before each attempt: where the run struggles, a step may take dozens of them.
    if (std::string reason = stop_conditions.reason_to_stop(); !reason.empty())
      return reason;
    const double dt = control->propose(options.interface_courant_number * system->capillary_time_step());
    try
    {
      const auto errors = system->try_step(dt);
      error_shape = errors.shape;
      error_composition = errors.composition;
    }
    catch (const SimulationError &error)
    {
      fail_step(dt, error.what());
      continue;
    }
    if (accept_step(dt))
      return "";
  }
}

template <int dim>
void VesicleProblem<dim>::fail_step(const double dt, const std::string &reason)
{
  ++n_rejected;
  ++n_attempts;
  if (repair_membrane(dt))
    return;
  control->fail(reason);
  log->info("step " + std::to_string(row.step + 1) + " at t = " + rounded(control->time()) +
            ", dt = " + rounded(dt) + " failed and is repeated with half the size: " + reason);
}

template <int dim>
bool VesicleProblem<dim>::accept_step(const double dt)
{
  const double tolerance = parameters.time_stepping.tolerance;
  bool is_good = false;
  try
  {
    is_good = control->judge(std::max(error_shape, error_composition) / tolerance, system->mesh_is_new());
  }
  catch (const SimulationError &)
  {
    // It already had the smallest size.
    ++n_rejected;
    ++n_attempts;
    if (repair_membrane(dt))
      return false;
    throw;
  }
  if (is_good)
  {
    if (control->noise_floor() > 0. && !system->mesh_is_new())
      log->warn_once("noise floor",
                     "at t = " + rounded(control->time()) + " the estimated local error (shape " +
                         rounded(error_shape) + ", composition " + rounded(error_composition) +
                         ") does not fall with the step size: it is one of the mesh, and tolerated. "
                         "Refine the mesh ('Mesh/Phase boundary level'), or loosen 'Time "
                         "stepping/Tolerance' = " +
                         rounded(tolerance) + ".");
    system->accept();
    n_attempts = 0;
    return true;
  }
  ++n_rejected;
  ++n_attempts;
  log->info("step " + std::to_string(row.step + 1) + " at t = " + rounded(control->time()) +
            ", dt = " + rounded(dt) + " rejected: error of the shape " + rounded(error_shape) +
            ", of the composition " + rounded(error_composition) + ", tolerance " + rounded(tolerance));
  repair_membrane(dt);
  return false;
}

template <int dim>
void VesicleProblem<dim>::write_results()
{
  try
  {
    report();
    write_output_if_due(control->finished());
    if (control->finished() || checkpoints->is_due(row.step))
      write_checkpoint();
  }
  catch (const SimulationError &error)
  {
    log->info("stopped at t = " + rounded(row.time) + " after " + std::to_string(row.step) +
              " steps: " + error.what());
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
       << rounded(wall_clock.cpu_time()) << " s CPU (" << rounded(wall_clock.wall_time()) << " s wall clock)";
  log->info(text.str());
  log->info("  the mesh has changed " + std::to_string(system->mesh_changes()) + " times; " +
            std::to_string(system->mesh().n_global_active_cells()) + " cells at the end");
  const auto cpu = system->timer().get_summary_data(TimerOutput::total_cpu_time);
  const double total = std::max(wall_clock.cpu_time(), 1e-6);
  for (const auto &[section, seconds] : cpu)
    log->info("  " + section + ": " + rounded(seconds) + " s CPU, " + rounded(100. * seconds / total) + " %");
}

template <int dim>
void check_case(const AllParameters &parameters, const MPI_Comm communicator)
{
  CoupledSystem<dim>(parameters, communicator).initialise();
}

template class VesicleProblem<2>;
template void check_case<2>(const AllParameters &, MPI_Comm);

template <>
VesicleProblem<3>::VesicleProblem(const AllParameters &, const MPI_Comm communicator, const std::string &,
                                  bool)
    : communicator(communicator), stop_conditions(0., communicator)
{
  throw ParameterError("Dimension",
                       "3 is not available yet: the parts are written for three dimensions, but the coupled "
                       "program needs an iterative flow solver first. Set Dimension = 2.");
}
template <>
VesicleProblem<3>::~VesicleProblem() = default;
template <>
int VesicleProblem<3>::run()
{
  return 1;
}
template <>
void check_case<3>(const AllParameters &parameters, const MPI_Comm communicator)
{
  VesicleProblem<3>(parameters, communicator, "", false);
}
} // namespace Gemmule
