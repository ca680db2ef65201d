// SPDX-License-Identifier: LGPL-2.1-or-later
// Saving what VesicleProblem carries from step to step, and going on from it.
#include <gemmule/application/checkpoints.h>
#include <gemmule/application/run_results.h>
#include <gemmule/application/vesicle_problem.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/coupling/coupled_system.h>

namespace Gemmule
{
using namespace dealii;

namespace
{
  constexpr int exit_code_stopped = 3;
} // namespace

template <int dim>
void VesicleProblem<dim>::continue_from(const RunState<dim> &state)
{
  is_resumed = true;
  control.restore(state.step_control);
  retries.restore(state.retries);
  earlier_wall_time = state.wall_time;
  for (const std::string &warning : results->missing_entries(state))
    log->warn(warning);
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
           results->write_membrane();
           return "interface.h5";
         });
  try_to("The state of that step", [&] { return write_checkpoint(); });
  log_end(reason + saved);
}

template <int dim>
void VesicleProblem<dim>::log_end(const std::string &reason)
{
  log->info("stopped at t = " + rounded(results->row().time) + " after " +
            std::to_string(results->row().step) + " steps: " + reason);
}

template <int dim>
std::string VesicleProblem<dim>::write_checkpoint()
{
  TimerOutput::Scope scope(system->timer(), "checkpoints");
  RunState<dim> state;
  state.system = system->state();
  state.step_control = control.memory();
  state.retries = retries.memory();
  state.wall_time = wall_time();
  results->save(state);
  system->forget_last_flow();
  return checkpoints->write(state, provenance);
}

template <int dim>
int VesicleProblem<dim>::stop(const std::string &reason)
{
  const std::string path = write_checkpoint();
  log->info("stopped by " + reason + " at t = " + rounded(results->row().time) + " after " +
            std::to_string(results->row().step) + " steps; the state is saved in " + path +
            ", and --resume continues from it.");
  log->check();
  return exit_code_stopped;
}

template void VesicleProblem<2>::continue_from(const RunState<2> &);
template void VesicleProblem<2>::log_end(const std::string &);
template void VesicleProblem<2>::save_last_state(const std::string &);
template std::string VesicleProblem<2>::write_checkpoint();
template int VesicleProblem<2>::stop(const std::string &);
} // namespace Gemmule
