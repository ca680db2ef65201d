// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/application/termination_signals.h>

#include <array>
#include <cerrno>
#include <ctime>
#include <unistd.h>
#include <utility>

namespace Gemmule
{
namespace
{
  // Of all signals that can be caught and whose default action ends the process these are left out: those of
  // a crash (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP, SIGSYS, SIGABRT), after which there is no state to
  // save.
  constexpr std::pair<int, const char *> named_signals[] = {
      {SIGINT, "SIGINT"},       {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"},   {SIGQUIT, "SIGQUIT"},
      {SIGUSR1, "SIGUSR1"},     {SIGUSR2, "SIGUSR2"}, {SIGXCPU, "SIGXCPU"}, {SIGALRM, "SIGALRM"},
      {SIGVTALRM, "SIGVTALRM"}, {SIGPROF, "SIGPROF"}, {SIGIO, "SIGIO"},
#ifdef SIGPWR
      {SIGPWR, "SIGPWR"},
#endif
#ifdef SIGSTKFLT
      {SIGSTKFLT, "SIGSTKFLT"},
#endif
  };

  /** Two that come together are one: some senders signal a process and its group. */
  constexpr double seconds_between_two = 1.;

  enum Phase : std::sig_atomic_t
  {
    ending,  ///< a signal ends the program
    noting,  ///< a signal is noted
    ignoring ///< a signal changes nothing any more
  };

  // All that a handler may touch.
  volatile std::sig_atomic_t phase = ending;
  volatile std::sig_atomic_t first_signal = 0;
  volatile std::sig_atomic_t interrupted = 0;
  timespec interrupted_at;
  struct Messages
  {
    std::string at_the_end, when_noted;
  };
  std::array<Messages, NSIG> messages;

  bool is_of_keyboard(const int signal)
  {
    return signal == SIGINT || signal == SIGQUIT;
  }

  void say(const std::string &message)
  {
    // Nothing can be done if nobody listens.
    if (write(STDERR_FILENO, message.data(), message.size()) < 0)
      return;
  }

  /** By the default action, so that who waits for the program learns of the signal. */
  void end_by(const int signal)
  {
    std::signal(signal, SIG_DFL);
    raise(signal); // delivered when the handler returns
  }

  extern "C" void handle_signal(const int signal)
  {
    const int error_before = errno;
    if (phase == ending)
    {
      say(messages[signal].at_the_end);
      end_by(signal);
    }
    else if (phase == noting)
    {
      if (first_signal == 0)
        first_signal = signal;
      if (is_of_keyboard(signal))
      {
        timespec now;
        clock_gettime(CLOCK_MONOTONIC, &now);
        if (interrupted == 0)
        {
          interrupted = 1;
          interrupted_at = now;
          say(messages[signal].when_noted);
        }
        else if (static_cast<double>(now.tv_sec - interrupted_at.tv_sec) +
                     1e-9 * static_cast<double>(now.tv_nsec - interrupted_at.tv_nsec) >=
                 seconds_between_two)
          end_by(signal);
      }
    }
    errno = error_before;
  }

  std::vector<int> termination_signals()
  {
    std::vector<int> signals;
    for (const auto &[signal, name] : named_signals)
      signals.push_back(signal);
    for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal)
      signals.push_back(signal);
    return signals;
  }

  std::vector<int> ignored_signals()
  {
    std::vector<int> ignored;
    for (const int signal : termination_signals())
    {
      struct sigaction present = {};
      if (sigaction(signal, nullptr, &present) == 0 && present.sa_handler == SIG_IGN)
        ignored.push_back(signal);
    }
    return ignored;
  }

  // Before main(): PETSc, which deal.II starts together with MPI, resets some of them.
  const std::vector<int> ignored_at_start = ignored_signals();
} // namespace

void TerminationSignals::keep_ignored()
{
  for (const int signal : ignored_at_start)
    std::signal(signal, SIG_IGN);
}

std::string TerminationSignals::name_of(const int signal)
{
  for (const auto &[number, name] : named_signals)
    if (number == signal)
      return name;
  return signal == SIGRTMIN ? "SIGRTMIN" : "SIGRTMIN+" + std::to_string(signal - SIGRTMIN);
}

TerminationSignals::TerminationSignals(const bool speaks)
{
  keep_ignored();
  phase = ending;
  first_signal = interrupted = 0;
  const auto change = [this](const int signal, void (*handler)(int))
  {
    struct sigaction action = {}, before = {};
    sigaction(signal, nullptr, &before);
    if (before.sa_handler != SIG_DFL && before.sa_handler != handle_signal)
      return;
    sigfillset(&action.sa_mask); // one at a time
    action.sa_handler = handler;
    // Whatever the libraries are reading or writing goes on.
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, nullptr);
    changed.push_back({signal, before});
  };
  for (const int signal : termination_signals())
  {
    if (speaks)
      messages[signal] = {
          "gemmule: stopped by " + name_of(signal) +
              " while the case was being set up; nothing has been written.\n",
          "gemmule: " + name_of(signal) +
              ": the state is saved as soon as the present attempt at a step is done. Another "
              "one ends the program at once, without saving.\n"};
    else
      messages[signal] = Messages();
    change(signal, handle_signal);
  }
  // Who presses Ctrl-C before `gemmule | tee log` ends tee first.
  for (const int signal : {SIGXFSZ, SIGPIPE})
    change(signal, SIG_IGN);
}

TerminationSignals::~TerminationSignals()
{
  // They go on coming (SIGXCPU every second) while what is left of the program comes to its end.
  if (phase == ignoring)
    return;
  for (const Disposition &disposition : changed)
    sigaction(disposition.signal, &disposition.before, nullptr);
}

void TerminationSignals::note_signals()
{
  phase = noting;
}

void TerminationSignals::ignore_signals()
{
  phase = ignoring;
}

int TerminationSignals::noted() const
{
  return static_cast<int>(first_signal);
}
} // namespace Gemmule
