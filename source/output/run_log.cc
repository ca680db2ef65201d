// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/rank_zero.h>
#include <gemmule/output/disk.h>
#include <gemmule/output/run_log.h>
#include <gemmule/parameters/text.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <sstream>
#include <unistd.h>

namespace Gemmule
{
namespace
{
  /** Seconds of wall clock between two progress lines where a line cannot be rewritten. */
  constexpr double seconds_between_lines = 10.;
  /** The same on a terminal: as often as the eye follows. */
  constexpr double seconds_between_refreshes = 0.1;
  /** Seconds of wall clock over which the pace is averaged: time steps grow, the start says little. */
  constexpr double pace_window = 60.;

  double seconds_now()
  {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
  }

  bool is_rank_zero(const MPI_Comm &communicator)
  {
    int rank = 0;
    MPI_Comm_rank(communicator, &rank);
    return rank == 0;
  }
} // namespace

RunLog::Console::Console() : Console(std::cout, isatty(STDOUT_FILENO) == 1, seconds_now) {}

RunLog::Console::Console(std::ostream &stream, const bool is_terminal, std::function<double()> wall_seconds)
    : stream(stream), is_terminal(is_terminal), wall_seconds(std::move(wall_seconds))
{
}

RunLog::RunLog(const std::string &directory, const MPI_Comm &communicator, const bool append,
               const Console &console)
    : communicator(communicator), is_active(is_rank_zero(communicator)), path(directory + "/log.txt"),
      console(console)
{
  on_rank_zero(communicator,
               [&]()
               {
                 if (!append)
                   replace_file(path, "");
                 append_to_file(path, "", /*create =*/true);
               });
}

RunLog::~RunLog()
{
  end_progress_line();
}

void RunLog::check()
{
  std::string before;
  std::swap(before, failure);
  on_rank_zero(communicator,
               [&]()
               {
                 if (!before.empty())
                   throw DiskError(before);
               });
}

void RunLog::append(const std::string &line)
{
  try
  {
    // A log without its beginning would not be known as that of a run.
    const std::string head =
        exists(path) ? "" : "Gemmule goes on here: log.txt was removed while the run was at work.\n";
    append_to_file(path, head + line + '\n', /*create =*/true);
  }
  catch (const DiskError &error)
  {
    failure = error.what();
  }
}

void RunLog::info(const std::string &text)
{
  write_line(text);
}

void RunLog::record(const std::string &text)
{
  if (is_active)
    append(text);
}

void RunLog::warn(const std::string &text)
{
  write_line("warning: " + text);
}

void RunLog::warn_once(const std::string &key, const std::string &text)
{
  if (warnings_given.insert(key).second)
    warn(text);
}

void RunLog::write_line(const std::string &line)
{
  if (!is_active)
    return;
  end_progress_line();
  append(line);
  // The console may be gone.
  console.stream << line << std::endl;
}

void RunLog::end_progress_line()
{
  if (open_line_length > 0)
    console.stream << std::endl;
  open_line_length = 0;
}

void RunLog::progress(const double time, const double end_time, const unsigned int step,
                      const double time_step)
{
  if (!is_active)
    return;
  const double now = console.wall_seconds();
  pace.emplace_back(now, time);
  while (pace.size() > 2 && pace.front().first < now - pace_window)
    pace.pop_front();

  const bool is_last = time >= end_time;
  const double interval = console.is_terminal ? seconds_between_refreshes : seconds_between_lines;
  if (!is_last && last_shown && now - *last_shown < interval)
    return;
  last_shown = now;

  const double simulated = time - pace.front().second;
  const double seconds_left = is_last         ? 0.
                              : simulated > 0 ? (end_time - time) * (now - pace.front().first) / simulated
                                              : std::numeric_limits<double>::infinity();
  const std::string line = format_progress(time, end_time, step, time_step, seconds_left);
  if (!console.is_terminal)
  {
    console.stream << line << std::endl;
    return;
  }
  const std::string blanks(open_line_length > line.size() ? open_line_length - line.size() : 0, ' ');
  console.stream << '\r' << line << blanks << std::flush;
  open_line_length = line.size();
}

std::string rounded(const double number)
{
  return Parameters::short_number(number, 4);
}

std::string format_duration(const double seconds)
{
  if (!std::isfinite(seconds))
    return "?";
  const long whole = std::lround(std::max(seconds, 0.));
  char text[64];
  if (whole < 60)
    std::snprintf(text, sizeof(text), "%ld s", whole);
  else if (whole < 3600)
    std::snprintf(text, sizeof(text), "%ld min %02ld s", whole / 60, whole % 60);
  else
    std::snprintf(text, sizeof(text), "%ld h %02ld min", whole / 3600, whole / 60 % 60);
  return text;
}

std::string format_progress(const double time, const double end_time, const unsigned int step,
                            const double time_step, const double seconds_left)
{
  const double percent = end_time > 0. ? 100. * std::min(time / end_time, 1.) : 100.;
  char text[160];
  // Rounded down, so that 100 % means finished.
  std::snprintf(text, sizeof(text), "%3.0f %%  time %.4f of %g, step %u, step size %.2e, ",
                std::floor(percent), time, end_time, step, time_step);
  return text + (seconds_left > 0. ? format_duration(seconds_left) + " left" : std::string("finished"));
}
} // namespace Gemmule
