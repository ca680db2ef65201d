// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/application/stop_conditions.h>
#include <gemmule/parameters/section.h>

#include <deal.II/base/mpi.h>

namespace Gemmule
{
StopConditions::StopConditions(const double wall_time_limit, const MPI_Comm communicator)
    : wall_time_limit(wall_time_limit), communicator(communicator),
      signals(/*speaks =*/dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
{
}

void StopConditions::setup_is_done()
{
  signals.note_signals();
  // Nobody may begin to write while a signal still ends another one, and all with it.
  MPI_Barrier(communicator);
}

std::string StopConditions::reason_to_stop()
{
  // A launcher may pass a signal on to some of its processes only, and the clocks differ: all do what one
  // wants.
  const bool out_of_time = wall_time_limit > 0. && wall_clock.wall_time() >= wall_time_limit;
  const int here[2] = {signals.noted(), static_cast<int>(out_of_time)};
  int anywhere[2];
  MPI_Allreduce(here, anywhere, 2, MPI_INT, MPI_MAX, communicator);
  if (anywhere[0] == 0 && anywhere[1] == 0)
    return "";
  signals.ignore_signals();
  if (anywhere[0] != 0)
    return "signal " + TerminationSignals::name_of(anywhere[0]);
  return "the wall time limit of " + Parameters::to_text(wall_time_limit) + " s";
}

void StopConditions::run_is_finished()
{
  signals.ignore_signals();
}
} // namespace Gemmule
