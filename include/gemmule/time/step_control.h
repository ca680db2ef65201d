// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/parameters/time_stepping.h>

#include <string>
#include <vector>

namespace Gemmule
{
/**
 * What StepControl remembers between two steps: with it another one with the same parameters continues
 * exactly. A new member needs a line in application/run_state.cc, so that checkpoints have it.
 */
struct StepControlMemory
{
  double now = 0.;
  double wanted = 0.;                             ///< step that the controller would like
  double rejected_step = 0., rejected_error = 0.; ///< last rejection at this time, if any
  double last_step = 0.;                          ///< size of the last accepted step; 0: none
  double floor = 0.;
  bool floor_passes = false;  ///< the floor comes from a change of the mesh
  unsigned int n_started = 0; ///< steps of the start that are done; n_halvings + 1: the start is over
};

/**
 * Chooses the time steps: an elementary controller on the local error of a second-order scheme, limits, and
 * the times that have to be hit exactly. Does no computation of its own, so that it can be tested without a
 * simulation.
 *
 * Start: BDF2 has no past, so that its first step is backward Euler, of local error O(dt^2). The first
 * initial step d is therefore split into d/16, d/16, d/8, d/4, d/2, which makes that error 256 times smaller,
 * at the ratio 2 of successive steps that BDF2 is stable for (1 + sqrt(2)).
 */
class StepControl : private StepControlMemory
{
public:
  /**
   * @param stops times to be hit exactly, of which the last is the end; unordered, more than once is fine
   */
  StepControl(const Parameters::TimeStepping &parameters, double start_time, std::vector<double> stops);

  double time() const { return now; }
  bool finished() const { return now >= stops.back(); }

  /**
   * Size of the next step: what the controller wants, at most @p stability_limit and 2.4 times the last one,
   * cut so that it ends on the next stop (or spreads what is left over two steps, to avoid a tiny last one).
   */
  double propose(double stability_limit);

  /**
   * @param error estimated local error of the proposed step, in units of the tolerance
   * @param on_new_mesh whether the mesh has changed within the time levels that the estimate looks at
   * @return whether the step is accepted; time() has then advanced. Otherwise propose() again.
   *
   * An estimate that does not fall in proportion when a step is repeated smaller is not an error of the time
   * discretisation (but, say, of a mesh that is too coarse for the phase boundaries), and no step size mends
   * it: the step is accepted, and what it showed is tolerated in the following steps, see noise_floor().
   * What shows on a new mesh (the fields of the earlier levels are those of coarser cells) is soon forgotten,
   * and steps do not grow until then.
   * Throws SimulationError when a rejected step already had the smallest size.
   */
  bool judge(double error, bool on_new_mesh = false);

  /**
   * The proposed step could not be computed: the next proposal is half as long.
   * @param reason goes into the message if that is below the smallest size (SimulationError)
   * @param remedy goes behind the reason in that message, if the reason itself does not say what to do
   */
  void fail(const std::string &reason, const std::string &remedy = "");

  /** The state at this time has no past any more: begins again as at the start. */
  void restart();

  /** Part of the estimates, in units of the tolerance, that does not depend on the step size; 0 if not
   * noticed. */
  double noise_floor() const { return floor; }

  const StepControlMemory &memory() const { return *this; }
  void restore(const StepControlMemory &memory) { static_cast<StepControlMemory &>(*this) = memory; }

private:
  void shrink(double factor, const std::string &reason);
  /** Size of the next step of the start. */
  double start_step() const;

  Parameters::TimeStepping parameters;
  std::vector<double> stops;
  double proposed = 0.;      ///< step in work
  bool is_cut_short = false; ///< by a stop
  unsigned int n_halvings;   ///< of the initial step, at the start
};
} // namespace Gemmule
