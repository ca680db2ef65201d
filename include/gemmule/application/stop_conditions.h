#pragma once

#include <deal.II/base/timer.h>

#include <csignal>
#include <mpi.h>
#include <string>

namespace Gemmule
{
/**
 * Why a run has to end before its time: SIGINT, SIGTERM, SIGUSR1 or SIGHUP (unless that
 * was ignored before, as nohup does) on any rank, or the limit of wall clock.
 * While an object lives, these signals do not end the program but are noted; a file that exceeds the user's
 * limit of size (SIGXFSZ) is an ordinary failure to write. At most one object at a time.
 */
class StopConditions
{
public:
  /** The clock starts now. @param wall_time_limit in seconds; 0: none */
  StopConditions(double wall_time_limit, MPI_Comm communicator);
  ~StopConditions();
  StopConditions(const StopConditions &) = delete;
  StopConditions &operator=(const StopConditions &) = delete;

  /** "signal SIGTERM" and the like, the same on all ranks; empty: go on. Collective. */
  std::string reason_to_stop() const;

private:
  static constexpr int n_signals = 6;
  const double wall_time_limit;
  const MPI_Comm communicator;
  const dealii::Timer wall_clock;
  struct sigaction before[n_signals];
};
} // namespace Gemmule
