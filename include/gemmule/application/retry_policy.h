// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/parameters/time_stepping.h>

namespace Gemmule
{
/**
 * What RetryPolicy remembers from attempt to attempt. A new member needs a line in application/run_state.cc,
 * so that checkpoints have it.
 */
struct RetryMemory
{
  unsigned int n_rejected = 0; ///< attempts of the whole run that were in vain
  unsigned int n_attempts = 0; ///< those at the step in work
  double last_repair = -1.;    ///< time of the last repair of the membrane, tried or done; negative: never
};

/**
 * Counts the attempts at a step that were in vain, and says when a shorter step will not do, so that the
 * membrane is looked at: one that the mesh does not resolve may be repaired. Computes nothing itself, so that
 * it can be tested without a simulation.
 */
class RetryPolicy : private RetryMemory
{
public:
  /** @param repairs_are_allowed "Membrane/Repair unresolved shapes" */
  RetryPolicy(const Parameters::TimeStepping &parameters, bool repairs_are_allowed);

  /** The attempt at a step was in vain. */
  void attempt_failed();

  /** The step is done. */
  void step_accepted() { n_attempts = 0; }

  /**
   * Is it time to repair the membrane if the mesh does not resolve it? After several attempts in vain, or
   * when steps are so short that there will not be many more; not soon after the last repair, since what has
   * not helped for so long will not help.
   *
   * @param time of the state from which the step is tried
   * @param dt size of the attempt that was in vain
   */
  bool may_repair(double time, double dt) const;

  /** A repair at @p time begins, which may fail. */
  void repair_begins(double time) { last_repair = time; }

  /** The step begins anew from a repaired membrane. */
  void membrane_is_repaired() { n_attempts = 0; }

  const RetryMemory &memory() const { return *this; }
  void restore(const RetryMemory &memory) { static_cast<RetryMemory &>(*this) = memory; }

private:
  const Parameters::TimeStepping parameters;
  const bool repairs_are_allowed;
};
} // namespace Gemmule
