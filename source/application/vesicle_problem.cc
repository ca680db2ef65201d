#include <gemmule/application/coupled_system.h>
#include <gemmule/application/reporting.h>
#include <gemmule/application/vesicle_problem.h>
#include <gemmule/output/output_directory.h>
#include <gemmule/parameters/errors.h>
#include <gemmule/time/step_control.h>
#include <gemmule/version.h>

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

  std::string rounded(const double x)
  {
    std::ostringstream text;
    text.precision(4);
    text << x;
    return text.str();
  }
} // namespace

template <int dim>
VesicleProblem<dim>::VesicleProblem(const AllParameters &parameters_, const MPI_Comm communicator_,
                                    const std::string &command_line_, const bool resume)
    : parameters(parameters_), communicator(communicator_), command_line(command_line_)
{
  if (resume)
    throw UserError(
        "--resume: checkpoints are not available in this version. Start the run anew without it.");
  // The case first: a mistake in it must not cost the results of an earlier run.
  system = std::make_unique<CoupledSystem<dim>>(parameters, communicator);
  system->initialise();

  directory = std::make_unique<OutputDirectory>(parameters.output_directory, communicator);
  log = std::make_unique<RunLog>(directory->path(), communicator);
  std::ostringstream values;
  parameters.print(values);
  directory->write_parameters(values.str());
  statistics = std::make_unique<StatisticsWriter>(directory->path(), communicator);
  interface_writer = std::make_unique<InterfaceWriter<dim>>(directory->path(), communicator, command_line);
  field_writer = std::make_unique<FieldWriter<dim>>(directory->path(), communicator);
  membrane = std::make_unique<InterfaceSamples<dim>>();
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
  log->info(std::string("Gemmule ") + GEMMULE_VERSION + " (" + GEMMULE_GIT_REVISION + "), " +
            std::to_string(Utilities::MPI::n_mpi_processes(communicator)) + " process(es): " + command_line);
  log->info("results in " + directory->path() + "; " + std::to_string(mesh.n_global_active_cells()) +
            " cells, " + std::to_string(system->get_flow().n_unknowns()) + " unknowns of the flow" +
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
  report();
  write_output_if_due(false);

  StepControl control(parameters.time_stepping, 0., stops());
  while (!control.finished())
  {
    try
    {
      make_step(control);
    }
    catch (const SimulationError &error)
    {
      save_last_state(error.what());
      throw;
    }
    report();
    write_output_if_due(control.finished());
    if (parameters.output.progress)
      log->progress(system->time(), parameters.end_time, row.step, row.time_step_size);
  }
  print_timers();
  return 0;
}

template <int dim>
void VesicleProblem<dim>::make_step(StepControl &control)
{
  const auto &options = parameters.time_stepping;
  while (true)
  {
    const double dt = control.propose(options.interface_courant_number * system->capillary_time_step());
    try
    {
      const auto errors = system->try_step(dt);
      error_shape = errors.shape;
      error_composition = errors.composition;
    }
    catch (const SimulationError &error)
    {
      ++n_rejected;
      control.fail(error.what());
      log->info("step " + std::to_string(row.step + 1) + " at t = " + rounded(control.time()) +
                ", dt = " + rounded(dt) + " failed and is repeated with half the size: " + error.what());
      continue;
    }
    if (control.judge(std::max(error_shape, error_composition) / options.tolerance))
    {
      if (control.noise_floor() > 0.)
        log->warn_once("noise floor",
                       "at t = " + rounded(control.time()) + " the estimated local error (shape " +
                           rounded(error_shape) + ", composition " + rounded(error_composition) +
                           ") does not fall with the step size: it is one of the mesh, and tolerated. "
                           "Refine the mesh ('Mesh/Phase boundary level'), or loosen 'Time "
                           "stepping/Tolerance' = " +
                           rounded(options.tolerance) + ".");
      system->accept();
      return;
    }
    ++n_rejected;
    log->info("step " + std::to_string(row.step + 1) + " at t = " + rounded(control.time()) +
              ", dt = " + rounded(dt) + " rejected: error of the shape " + rounded(error_shape) +
              ", of the composition " + rounded(error_composition) + ", tolerance " +
              rounded(options.tolerance));
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
  row.wall_time = wall_clock.wall_time();
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

  if (row.tension_min < 0.)
    log->warn_once(
        "negative tension",
        "the tension is negative on a part of the membrane since t = " + rounded(row.time) + " (minimum " +
            rounded(row.tension_min) +
            "). Without bending stiffness short waves of the shape then grow at the rate |sigma| k / 4: "
            "wrinkles get the wavelength of the mesh.");
  if (system->lowered_levels() > 0)
    log->warn_once("too many cells", "the mesh needs more than 'Mesh/Largest number of cells' = " +
                                         std::to_string(parameters.mesh.largest_number_of_cells) +
                                         " cells; the finest level is lowered.");
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
void VesicleProblem<dim>::save_last_state(const std::string &reason)
{
  // The mesh already belongs to the step that failed; the membrane of the last accepted step is kept as
  // samples.
  if (!membrane_is_written)
    interface_writer->write(*membrane);
  log->info("stopped at t = " + rounded(row.time) + " after " + std::to_string(row.step) +
            " steps: " + reason + " The membrane of the last accepted step is in interface.h5.");
}

template <int dim>
void VesicleProblem<dim>::print_timers()
{
  std::ostringstream text;
  text << "finished: t = " << row.time << ", " << row.step << " steps, " << n_rejected << " rejected, "
       << rounded(wall_clock.cpu_time()) << " s CPU (" << rounded(wall_clock.wall_time()) << " s wall clock)";
  log->info(text.str());
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
    : communicator(communicator)
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
