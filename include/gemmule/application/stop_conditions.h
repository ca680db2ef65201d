// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/application/termination_signals.h>

#include <deal.II/base/timer.h>

#include <mpi.h>
#include <string>

namespace Gemmule
{
/**
 * Why a run has to end before its time: a signal of TerminationSignals on any rank, or the limit of wall
 * clock. Until setup_is_done() a signal ends the program at once, since there is nothing to save. At most one
 * object at a time.
 */
class StopConditions
{
public:
  /** The clock starts now. @param wall_time_limit in seconds; 0: none */
  StopConditions(double wall_time_limit, MPI_Comm communicator);

  /** From now on signals are noted, on all ranks when it returns. Collective. */
  void setup_is_done();

  /**
   * "signal SIGTERM" and the like, the same on all ranks; empty: go on. After a reason no further signal
   * keeps the program from saving its state. Collective.
   */
  std::string reason_to_stop();

  /** All is written: no signal changes any more how the program ends. */
  void run_is_finished();

private:
  const double wall_time_limit;
  const MPI_Comm communicator;
  const dealii::Timer wall_clock;
  TerminationSignals signals;
};
} // namespace Gemmule
