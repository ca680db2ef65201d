// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deque>
#include <functional>
#include <iosfwd>
#include <mpi.h>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace Gemmule
{
/**
 * Messages of a run, to log.txt and to the console, and a line that shows how far it is. Rank 0 writes; every
 * rank may call; only construction and check() are collective.
 */
class RunLog
{
public:
  /** Where the console is and what it can do; replaced in tests. */
  struct Console
  {
    /** Standard output. */
    Console();

    std::ostream &stream;
    bool is_terminal;                     ///< a line can be rewritten in place
    std::function<double()> wall_seconds; ///< a clock that never goes back

    Console(std::ostream &stream, bool is_terminal, std::function<double()> wall_seconds);
  };

  /**
   * @param directory existing directory of the results
   * @param append keep what an earlier run wrote (for a run that is resumed)
   *
   * @throws DiskError when log.txt cannot be written
   */
  RunLog(const std::string &directory, const MPI_Comm &communicator, bool append = false,
         const Console &console = Console());

  /** Ends a progress line that is still open. */
  ~RunLog();

  RunLog(const RunLog &) = delete;
  RunLog &operator=(const RunLog &) = delete;

  /**
   * Has log.txt taken everything so far? A message itself never throws: the ranks would not do so together.
   * @throws DiskError if not; only once for each failure. Collective.
   */
  void check();

  void info(const std::string &text);

  /** Only to log.txt: what is of interest later. */
  void record(const std::string &text);

  /** info() with the prefix "warning: ". */
  void warn(const std::string &text);

  /** warn(), but only the first time that @p key is given. */
  void warn_once(const std::string &key, const std::string &text);

  /**
   * Show how far the run is and how long it will take: one line that is rewritten in place on a terminal,
   * otherwise a line at most every 10 seconds. Not written to log.txt (statistics.csv has it all).
   *
   * @param step accepted steps so far
   * @param time_step size of the last step
   */
  void progress(double time, double end_time, unsigned int step, double time_step);

private:
  void write_line(const std::string &line);
  void append(const std::string &line);
  void end_progress_line();

  const MPI_Comm communicator;
  const bool is_active;
  const std::string path;
  Console console;
  std::string failure; ///< why log.txt lacks something; empty if it does not
  std::set<std::string> warnings_given;
  std::size_t open_line_length = 0;           ///< characters of the progress line that is on the terminal
  std::deque<std::pair<double, double>> pace; ///< (wall clock, simulated time) of the last minute
  std::optional<double> last_shown;           ///< wall clock of the last progress line
};

/** The number as the messages of a run show it, with four digits. */
std::string rounded(double number);

/** "42 s", "3 min 05 s", "2 h 07 min"; "?" when not finite. */
std::string format_duration(double seconds);

/** The line that RunLog::progress() shows; @p seconds_left may be infinite (not known yet). */
std::string format_progress(double time, double end_time, unsigned int step, double time_step,
                            double seconds_left);
} // namespace Gemmule
