// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/application/case_check.h>
#include <gemmule/application/checkpoints.h>
#include <gemmule/application/run_results.h>
#include <gemmule/application/step_attempts.h>
#include <gemmule/application/vesicle_problem.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/base/rank_zero.h>
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/output/disk_error.h>
#include <gemmule/output/output_directory.h>

#include <optional>
#include <sstream>

namespace Gemmule
{
using namespace dealii;

template <int dim>
VesicleProblem<dim>::VesicleProblem(const AllParameters &parameters, const MPI_Comm communicator,
                                    const std::string &command_line, const bool resume)
    : parameters(parameters), communicator(communicator), command_line(command_line),
      stop_conditions(parameters.checkpoint.wall_time_limit, communicator),
      provenance(command_line, parameters.values()), schedule(parameters.output, parameters.end_time),
      control(parameters.time_stepping, 0., schedule.stops()),
      retries(parameters.time_stepping, parameters.membrane.repair_unresolved_shapes),
      checkpoints(std::make_unique<Checkpoints<dim>>(parameters, communicator))
{
  try
  {
    set_up(resume);
  }
  catch (const DiskError &error)
  {
    const SimulationError reason = advised(error);
    if (directory)
      directory->remove_begun_results();
    throw reason;
  }
}

template <int dim>
void VesicleProblem<dim>::set_up(const bool resume)
{
  // What is wrong with the directory is found before anything is computed, and before anything is read that
  // another run may be changing.
  std::unique_ptr<DirectoryLock> lock;
  bool begins_anew = false;
  on_rank_zero(communicator,
               [&]()
               {
                 lock = OutputDirectory::check(parameters.output_directory, resume);
                 begins_anew = resume && OutputDirectory::has_only_begun(parameters.output_directory);
               });
  begins_anew = Utilities::MPI::broadcast(communicator, begins_anew, 0);
  std::vector<std::string> notes;
  std::optional<RunState<dim>> resumed;
  if (resume && !begins_anew)
    resumed = checkpoints->load(notes);

  // The case first: a mistake in it must not cost the results of an earlier run.
  system = std::make_unique<CoupledSystem<dim>>(parameters, communicator);
  if (resumed)
    system->restore(resumed->system);
  else
    system->initialise();

  stop_conditions.setup_is_done();
  open_output(resumed ? &*resumed : nullptr, std::move(lock), notes);
  make_attempts();
  if (resumed)
    continue_from(*resumed);
  if (begins_anew)
    notes.push_back(
        "--resume: the run in this directory had ended before its first checkpoint. It begins anew.");
  for (const std::string &note : notes)
    log->warn(note);
}

template <int dim>
void VesicleProblem<dim>::open_output(const RunState<dim> *resumed, std::unique_ptr<DirectoryLock> lock,
                                      std::vector<std::string> &notes)
{
  directory = std::make_unique<OutputDirectory>(parameters.output_directory, communicator, resumed != nullptr,
                                                std::move(lock));
  if (resumed != nullptr)
  {
    if (const std::string note = directory->move_foreign_files(resumed->n_field_files); !note.empty())
      notes.push_back(note);
    checkpoints->restore_results();
  }
  log = std::make_unique<RunLog>(directory->path(), communicator, resumed != nullptr);
  std::ostringstream values;
  parameters.print(values);
  directory->write_parameters(values.str());
  results = std::make_unique<RunResults<dim>>(directory->path(), communicator, provenance, schedule, resumed);
}

template <int dim>
VesicleProblem<dim>::~VesicleProblem() = default;

template <int dim>
void VesicleProblem<dim>::announce() const
{
  const auto &mesh = system->mesh();
  log->info("Gemmule " + program_version() + ", " +
            std::to_string(Utilities::MPI::n_mpi_processes(communicator)) + " process(es): " + command_line);
  for (const auto &[name, value] : provenance.entries())
    log->record(name + (value.find('\n') == std::string::npos ? ": " : ":\n") + value);
  const std::string cells = std::to_string(mesh.n_global_active_cells()) + " cells";
  if (const std::string &earlier = directory->earlier_run(); !earlier.empty())
    log->warn("the directory held a run that " + directory->reason_of_move() + ". Its results are in " +
              earlier + " now" +
              (can_be_resumed(earlier) ? ", and --resume --output " + earlier + " continues it."
                                       : "; it has no checkpoint that this version could continue."));
  if (is_resumed)
    log->info("resumed at t = " + rounded(results->row().time) + " after " +
              std::to_string(results->row().step) + " steps; results in " + directory->path() + "; " + cells);
  else
    log->info("results in " + directory->path() + "; " + cells + ", " +
              std::to_string(system->get_flow().n_unknowns()) + " unknowns of the flow" +
              (system->get_surface() != nullptr
                   ? ", " + std::to_string(system->get_surface()->n_unknowns()) + " of the phases"
                   : "") +
              "; the flow is solved by " + describe(system->get_flow().linear_solver_report(), communicator));
  for (const std::string &warning : warnings_before_start(*system))
    log->warn(warning);
}

template <int dim>
SimulationError VesicleProblem<dim>::advised(const DiskError &error) const
{
  return SimulationError(error.what() + checkpoints->how_to_go_on());
}

template <int dim>
int VesicleProblem<dim>::run()
{
  announce();
  try
  {
    return run_steps();
  }
  catch (const DiskError &error)
  {
    const SimulationError reason = advised(error);
    log_end(reason.what());
    directory->remove_begun_results();
    throw reason;
  }
}

template <int dim>
int VesicleProblem<dim>::run_steps()
{
  if (!is_resumed)
  {
    report();
    results->write_if_due(*system);
    // From now on there is something to resume, whatever happens.
    write_checkpoint();
  }
  else if (control.finished())
  {
    // It was stopped where it ends now.
    results->write_membrane();
    write_checkpoint();
  }

  while (!control.finished())
  {
    if (const std::string reason = make_step(); !reason.empty())
      return stop(reason);
    write_results();
    if (parameters.output.progress)
      log->progress(control.time(), parameters.end_time, results->row().step, results->row().time_step_size);
  }
  stop_conditions.run_is_finished();
  print_timers();
  log->check();
  return 0;
}

template class VesicleProblem<2>;

template <>
VesicleProblem<3>::VesicleProblem(const AllParameters &parameters, const MPI_Comm communicator,
                                  const std::string &, bool)
    : parameters(parameters), communicator(communicator), stop_conditions(0., communicator),
      schedule(parameters.output, parameters.end_time),
      control(parameters.time_stepping, 0., schedule.stops()),
      retries(parameters.time_stepping, parameters.membrane.repair_unresolved_shapes)
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
} // namespace Gemmule
