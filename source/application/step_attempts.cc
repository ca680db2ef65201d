// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/application/step_attempts.h>
#include <gemmule/parameters/text.h>

#include <algorithm>

namespace Gemmule
{
StepAttempts::StepAttempts(TrialSystem &system, StepControl &control, RetryPolicy &policy, RunLog &log,
                           const double tolerance)
    : system(system), control(control), policy(policy), log(log), tolerance(tolerance)
{
}

std::string StepAttempts::make_step(const unsigned int step,
                                    const std::function<std::string()> &reason_to_stop)
{
  step_in_work = step;
  while (true)
  {
    if (std::string reason = reason_to_stop(); !reason.empty())
      return reason;
    const double dt = control.propose(system.longest_step());
    try
    {
      last_errors = system.try_step(dt);
    }
    catch (const SimulationError &error)
    {
      fail(dt, error);
      continue;
    }
    if (accept(dt))
      return "";
  }
}

std::string StepAttempts::step_at_time(const double dt) const
{
  return "step " + std::to_string(step_in_work) + " at t = " + rounded(control.time()) +
         ", dt = " + rounded(dt);
}

void StepAttempts::fail(const double dt, const SimulationError &error)
{
  const std::string reason = error.what();
  policy.attempt_failed();
  if (repair_membrane(dt))
    return;
  // A wall, say, or a lack of memory has a remedy of its own.
  const bool is_breakdown = dynamic_cast<const StepBreakdown *>(&error) != nullptr;
  control.fail(reason, is_breakdown ? "Refine the mesh, or allow shorter steps with 'Time stepping/Smallest "
                                      "time step'." +
                                          system.explanation_of_failure()
                                    : "");
  log.info(step_at_time(dt) + " failed and is repeated with half the size: " + reason);
}

bool StepAttempts::accept(const double dt)
{
  bool is_good = false;
  try
  {
    is_good =
        control.judge(std::max(last_errors.shape, last_errors.composition) / tolerance, system.mesh_is_new());
  }
  catch (const SimulationError &error)
  {
    // It already had the smallest size.
    policy.attempt_failed();
    if (repair_membrane(dt))
      return false;
    throw SimulationError(error.what() + system.explanation_of_failure());
  }
  if (is_good)
  {
    if (control.noise_floor() > 0. && !system.mesh_is_new())
      log.warn_once("noise floor",
                    "at t = " + rounded(control.time()) + " the estimated local error (shape " +
                        rounded(last_errors.shape) + ", composition " + rounded(last_errors.composition) +
                        ") does not fall with the step size: it is one of the mesh, and tolerated. "
                        "Refine the mesh ('Mesh/Phase boundary level'), or loosen 'Time "
                        "stepping/Tolerance' = " +
                        rounded(tolerance) + ".");
    system.accept();
    policy.step_accepted();
    return true;
  }
  policy.attempt_failed();
  log.info(step_at_time(dt) + " rejected: error of the shape " + rounded(last_errors.shape) +
           ", of the composition " + rounded(last_errors.composition) + ", tolerance " + rounded(tolerance));
  repair_membrane(dt);
  return false;
}

bool StepAttempts::repair_membrane(const double dt)
{
  if (!policy.may_repair(control.time(), dt) || system.membrane_is_resolved())
    return false;
  policy.repair_begins(control.time());
  const std::string at = "at t = " + rounded(control.time());
  try
  {
    const RepairReport report = system.repair_membrane();
    log.info("the membrane " + at +
             " has been repaired, and the run begins anew from there: what was thinner than " +
             rounded(2. * report.radius) + " is gone; arclength " +
             Parameters::short_number(report.arclength_before, 8) + " before and " +
             Parameters::short_number(report.arclength_after, 8) + " after.");
  }
  catch (const SimulationError &error)
  {
    log.info("the membrane " + at + " cannot be repaired: " + error.what());
    return false;
  }
  log.warn_once("repair", "steps fail, and the mesh does not resolve the membrane since t = " +
                              rounded(control.time()) +
                              ": it is repaired ('Membrane/Repair unresolved shapes'), by topological "
                              "changes where two sheets share a cell. What follows depends on the mesh; "
                              "bending rigidity or a finer mesh may avoid it.");
  control.restart();
  policy.membrane_is_repaired();
  return true;
}
} // namespace Gemmule
