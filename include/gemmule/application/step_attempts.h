// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/application/retry_policy.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/coupling/step_errors.h>
#include <gemmule/output/run_log.h>
#include <gemmule/time/step_control.h>

#include <functional>
#include <string>

namespace Gemmule
{
/** What StepAttempts makes steps of: in a run the coupled system, in tests something simpler. */
class TrialSystem
{
public:
  virtual ~TrialSystem() = default;

  /** The longest step that is stable from the current state. */
  virtual double longest_step() const = 0;
  /** Computes the next state. @throws SimulationError when that is impossible */
  virtual StepErrors try_step(double dt) = 0;
  /** Has the mesh changed within the time levels that the errors of the last try look at? */
  virtual bool mesh_is_new() const = 0;
  /** Makes the state of the last try the current one. */
  virtual void accept() = 0;

  /** Does the mesh resolve the membrane of the current state? */
  virtual bool membrane_is_resolved() const = 0;
  /** Begins anew from a membrane that it does. @throws SimulationError when that is impossible: nothing has
   * changed then */
  virtual RepairReport repair_membrane() = 0;

  /** What is to be said of the current state when no step from it succeeds: a sentence, or nothing. */
  virtual std::string explanation_of_failure() const = 0;
};

/**
 * Makes steps, each in as many attempts as it takes: shorter ones after an attempt that cannot be computed or
 * is not accurate, from a repaired membrane where the mesh does not resolve it any more. The log gets a line
 * on each attempt in vain. All objects must outlive this one.
 */
class StepAttempts
{
public:
  /** @param tolerance of the local errors */
  StepAttempts(TrialSystem &system, StepControl &control, RetryPolicy &policy, RunLog &log, double tolerance);

  /**
   * One accepted step.
   *
   * @param step its number, for messages
   * @param reason_to_stop is asked before each attempt: where the run struggles, a step may take dozens
   * @return what it has answered, if not empty, before the step was done; else empty
   * @throws SimulationError when no attempt succeeds
   */
  std::string make_step(unsigned int step, const std::function<std::string()> &reason_to_stop);

  /** Of the last attempt that could be computed; zero before the first one. */
  const StepErrors &errors() const { return last_errors; }

private:
  /** @return whether a step of size @p dt that could be computed is good enough */
  bool accept(double dt);
  /** After an attempt of size @p dt that could not be computed: the next one is smaller, or from a repair on.
   */
  void fail(double dt, const SimulationError &error);
  /**
   * After an attempt of size @p dt in vain: repairs the membrane if it is the reason and that is allowed.
   * @return whether the step can be tried again from a new beginning.
   */
  bool repair_membrane(double dt);
  std::string step_at_time(double dt) const;

  TrialSystem &system;
  StepControl &control;
  RetryPolicy &policy;
  RunLog &log;
  const double tolerance;
  StepErrors last_errors;
  unsigned int step_in_work = 0;
};
} // namespace Gemmule
