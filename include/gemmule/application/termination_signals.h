// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <csignal>
#include <string>
#include <vector>

namespace Gemmule
{
/**
 * What happens on signals that end a program and can be caught, other than those of a crash: SIGINT (Ctrl-C),
 * SIGTERM, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGXCPU and their like, real-time signals included. A signal
 * that was ignored when the program was started (as `nohup` does with SIGHUP, and a shell without job control
 * with SIGINT and SIGQUIT for what it starts in the background), or that somebody else handles (a profiler),
 * stays as it is.
 *
 * At first such a signal ends the program at once, by its default action, with a message. From note_signals()
 * on it is noted, and the program goes on. Only a second SIGINT or SIGQUIT, at least a second after the first
 * one, still ends it, unless ignore_signals() says otherwise.
 *
 * While an object lives, SIGPIPE and SIGXFSZ are ignored: a pipe or a file that takes no more is an error of
 * that write. At most one object at a time.
 */
class TerminationSignals
{
public:
  /** @param speaks whether this process tells of signals on the standard error; one of several is enough */
  explicit TerminationSignals(bool speaks);
  /** All is as it was before, unless signals are ignored: so they stay. */
  ~TerminationSignals();
  TerminationSignals(const TerminationSignals &) = delete;
  TerminationSignals &operator=(const TerminationSignals &) = delete;

  /**
   * What was ignored when the program was started is ignored again: libraries that are initialised may reset
   * it. The constructor does the same.
   */
  static void keep_ignored();

  void note_signals();
  /** From now on no signal ends the program. */
  void ignore_signals();

  /** The first one that was noted; 0: none. */
  int noted() const;

  /** "SIGTERM" and the like. @param signal one of those that are caught */
  static std::string name_of(int signal);

private:
  struct Disposition
  {
    int signal;
    struct sigaction before;
  };
  std::vector<Disposition> changed;
};
} // namespace Gemmule
