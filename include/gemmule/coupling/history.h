// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/geometry/membrane_snapshot.h>
#include <gemmule/time/time_step.h>
#include <gemmule/time/time_step_limits.h>

namespace Gemmule
{
/**
 * The accepted time levels that a step builds on, as plain data that checkpoints keep. Level n is the newest
 * one. A new member needs a line in exchange() (coupled_state.cc).
 */
template <int dim>
struct AcceptedLevels
{
  MembraneSnapshot<dim> level_n, level_n_minus_1; ///< the latter is empty where level n is the first one
  double step_to_n = 0.;                          ///< t_n - t_{n-1} (dimensionless); 0: level n is the first
  double step_to_n_minus_1 = 0.;                  ///< t_{n-1} - t_{n-2}; 0: there is no level n-2
  TimeStepLimits limits;                          ///< of the step that leads away from level n
};

/**
 * The past of the membrane: the accepted levels n and n-1, the sizes of the steps between them, and the
 * coefficients of the next step. Nothing but accept(), begin() and restore() changes it: a try that is
 * rejected leaves it bitwise as it was. The levels do not depend on the mesh and are complete on every rank.
 */
template <int dim>
class History
{
public:
  /** Forgets everything: @p level is the first one. @p limits of the step that leads away from it. */
  void begin(MembraneSnapshot<dim> level, const TimeStepLimits &limits);

  /** @p level, to which a step of size @p step has led, becomes level n, and level n becomes level n-1. */
  void accept(MembraneSnapshot<dim> level, double step, const TimeStepLimits &limits);

  /** The step of size @p size to level n+1, with its coefficients. */
  TimeStep next_step(double size) const { return TimeStep(size, levels.step_to_n, levels.step_to_n_minus_1); }

  const MembraneSnapshot<dim> &level_n() const { return levels.level_n; }
  /** nullptr if level n is the first one. */
  const MembraneSnapshot<dim> *level_n_minus_1() const
  {
    return levels.step_to_n > 0. ? &levels.level_n_minus_1 : nullptr;
  }

  /** t_n */
  double time() const { return levels.level_n.time; }
  /** t_n - t_{n-1}; 0 if level n is the first one. */
  double last_step() const { return levels.step_to_n; }
  const TimeStepLimits &limits() const { return levels.limits; }

  const AcceptedLevels<dim> &accepted() const { return levels; }
  void restore(const AcceptedLevels<dim> &accepted) { levels = accepted; }

private:
  AcceptedLevels<dim> levels;
};
} // namespace Gemmule
