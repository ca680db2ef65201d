#include <gemmule/application/stop_conditions.h>

#include <deal.II/base/mpi.h>

#include <sstream>

namespace Gemmule
{
namespace
{
  // All that a handler may touch.
  volatile std::sig_atomic_t received_signal = 0;

  extern "C" void note_signal(const int signal)
  {
    received_signal = signal;
  }

  // The last two are ignored: a file or a pipe that takes no more is an error of that write, not the end. Who
  // presses Ctrl-C before `gemmule | tee log` ends tee first.
  constexpr int signals[] = {SIGINT, SIGTERM, SIGUSR1, SIGHUP, SIGXFSZ, SIGPIPE};

  std::string name_of(const int signal)
  {
    return signal == SIGINT    ? "SIGINT"
           : signal == SIGTERM ? "SIGTERM"
           : signal == SIGHUP  ? "SIGHUP"
                               : "SIGUSR1";
  }
} // namespace

StopConditions::StopConditions(const double wall_time_limit, const MPI_Comm communicator)
    : wall_time_limit(wall_time_limit), communicator(communicator)
{
  received_signal = 0;
  for (int i = 0; i < n_signals; ++i)
  {
    struct sigaction action = {};
    sigemptyset(&action.sa_mask);
    action.sa_handler = signals[i] == SIGXFSZ || signals[i] == SIGPIPE ? SIG_IGN : note_signal;
    // Whatever the libraries are reading or writing goes on.
    action.sa_flags = SA_RESTART;
    sigaction(signals[i], &action, &before[i]);
    // Who starts a run with nohup wants it to survive the terminal.
    if (signals[i] == SIGHUP && before[i].sa_handler == SIG_IGN)
      sigaction(signals[i], &before[i], nullptr);
  }
}

StopConditions::~StopConditions()
{
  for (int i = 0; i < n_signals; ++i)
    sigaction(signals[i], &before[i], nullptr);
}

std::string StopConditions::reason_to_stop() const
{
  // A launcher may pass a signal on to some of its processes only, and the clocks differ: all do what one
  // wants.
  const bool out_of_time = wall_time_limit > 0. && wall_clock.wall_time() >= wall_time_limit;
  const int here[2] = {static_cast<int>(received_signal), static_cast<int>(out_of_time)};
  int anywhere[2];
  MPI_Allreduce(here, anywhere, 2, MPI_INT, MPI_MAX, communicator);
  if (anywhere[0] != 0)
    return "signal " + name_of(anywhere[0]);
  std::ostringstream reason;
  if (anywhere[1] != 0)
    reason << "the wall time limit of " << wall_time_limit << " s";
  return reason.str();
}
} // namespace Gemmule
