// SPDX-License-Identifier: LGPL-2.1-or-later
// Saving what VesicleProblem carries from step to step, and going on from it.
#include <gemmule/application/checkpoints.h>
#include <gemmule/application/vesicle_problem.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/output/field_output.h>
#include <gemmule/time/step_control.h>

namespace Gemmule
{
using namespace dealii;

namespace
{
  constexpr int exit_code_stopped = 3;
} // namespace

template <int dim>
void VesicleProblem<dim>::continue_from(RunState<dim> &state)
{
  is_resumed = true;
  control->restore(state.step_control);
  row = state.row;
  *membrane = std::move(state.membrane);
  membrane_is_written = state.membrane_is_written;
  n_rejected = state.n_rejected;
  n_attempts = state.n_attempts;
  last_repair = state.last_repair;
  earlier_wall_time = state.wall_time;

  // What is known on rank 0 only is compared there only; the other ranks' log is silent.
  const auto compare = [&](const std::string &what, const std::size_t present, const std::size_t written)
  {
    if (Utilities::MPI::this_mpi_process(communicator) == 0 && present != written)
      log->warn(what + " has " + std::to_string(present) + " of the " + std::to_string(written) +
                " entries that had been written up to the checkpoint; the rest is missing or damaged.");
  };
  compare("statistics.csv", statistics->n_rows(), row.step + 1);
  compare("interface.h5", interface_writer->n_groups(), state.n_interface_groups);
  compare("solution.xdmf", field_writer->n_listed(), state.n_field_files);
}

template <int dim>
void VesicleProblem<dim>::save_last_state(const std::string &reason)
{
  std::string saved;
  // The first error is the one that counts.
  const auto try_to = [&saved](const std::string &what, const auto &action)
  {
    try
    {
      saved += " " + what + " is in " + action() + ".";
    }
    catch (const std::exception &error)
    {
      saved += " " + what + " cannot be saved: " + error.what();
    }
  };
  // The mesh already belongs to the step that failed; the membrane of the last accepted step is kept as
  // samples.
  try_to("The membrane of the last accepted step",
         [&]() -> std::string
         {
           if (!membrane_is_written)
             interface_writer->write(*membrane);
           membrane_is_written = true;
           return "interface.h5";
         });
  try_to("The state of that step", [&] { return write_checkpoint(); });
  log_end(reason + saved);
}

template <int dim>
void VesicleProblem<dim>::log_end(const std::string &reason)
{
  log->info("stopped at t = " + rounded(row.time) + " after " + std::to_string(row.step) +
            " steps: " + reason);
}

template <int dim>
std::string VesicleProblem<dim>::write_checkpoint()
{
  TimerOutput::Scope scope(system->timer(), "checkpoints");
  RunState<dim> state;
  state.system = system->state();
  state.step_control = control->memory();
  state.row = row;
  state.membrane = *membrane;
  state.membrane_is_written = membrane_is_written;
  state.n_rejected = n_rejected;
  state.n_attempts = n_attempts;
  state.last_repair = last_repair;
  state.wall_time = earlier_wall_time + wall_clock.wall_time();
  state.n_interface_groups = interface_writer->n_groups();
  state.n_field_files = field_writer->n_files();
  return checkpoints->write(state, provenance);
}

template <int dim>
int VesicleProblem<dim>::stop(const std::string &reason)
{
  const std::string path = write_checkpoint();
  log->info("stopped by " + reason + " at t = " + rounded(row.time) + " after " + std::to_string(row.step) +
            " steps; the state is saved in " + path + ", and --resume continues from it.");
  log->check();
  return exit_code_stopped;
}

template void VesicleProblem<2>::continue_from(RunState<2> &);
template void VesicleProblem<2>::log_end(const std::string &);
template void VesicleProblem<2>::save_last_state(const std::string &);
template std::string VesicleProblem<2>::write_checkpoint();
template int VesicleProblem<2>::stop(const std::string &);
} // namespace Gemmule
