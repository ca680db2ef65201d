// SPDX-License-Identifier: LGPL-2.1-or-later
// The steps of VesicleProblem, with all that can go wrong in them.
#include <gemmule/application/vesicle_problem.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/output/run_log.h>
#include <gemmule/parameters/text.h>
#include <gemmule/time/step_control.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // When a membrane that the mesh does not resolve is repaired: after so many attempts at one step, or when
  // steps are below so many times the smallest.
  constexpr unsigned int attempts_before_repair = 4;
  constexpr double small_steps = 100.;
  // In initial steps.
  constexpr double least_time_between_repairs = 0.1;
} // namespace

template <int dim>
std::string VesicleProblem<dim>::make_step()
{
  try
  {
    return attempt_step();
  }
  catch (const SimulationError &error)
  {
    save_last_state(error.what());
    throw;
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
    // Of what kind it may be, it need not have happened on all ranks, and not where the state is whole: what
    // there is to go on with is the last checkpoint.
    log_end(error.what());
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
  // What has not helped for so long will not help.
  if (control->time() < last_repair + least_time_between_repairs * options.initial_step ||
      system->membrane_is_resolved())
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
    const double dt =
        control->propose(system->time_step_limits().longest_step(options.interface_courant_number));
    try
    {
      const auto errors = system->try_step(dt);
      error_shape = errors.shape;
      error_composition = errors.composition;
    }
    catch (const SimulationError &error)
    {
      fail_step(dt, error);
      continue;
    }
    if (accept_step(dt))
      return "";
  }
}

template <int dim>
void VesicleProblem<dim>::fail_step(const double dt, const SimulationError &error)
{
  const std::string reason = error.what();
  ++n_rejected;
  ++n_attempts;
  if (repair_membrane(dt))
    return;
  // A wall, say, or a lack of memory has a remedy of its own.
  const bool is_breakdown = dynamic_cast<const StepBreakdown *>(&error) != nullptr;
  control->fail(reason, is_breakdown ? "Refine the mesh, or allow shorter steps with 'Time stepping/Smallest "
                                       "time step'." +
                                           end_of_the_model()
                                     : "");
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
  catch (const SimulationError &error)
  {
    // It already had the smallest size.
    ++n_rejected;
    ++n_attempts;
    if (repair_membrane(dt))
      return false;
    throw SimulationError(error.what() + end_of_the_model());
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

template std::string VesicleProblem<2>::make_step();
} // namespace Gemmule
