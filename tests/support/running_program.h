// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <chrono>
#include <csignal>
#include <functional>
#include <optional>
#include <sys/resource.h>
#include <thread>
#include <vector>

#include "support/run_program.h"

namespace Gemmule::Testing
{
/** The program while it runs, to send it signals. Its output goes to .stdout and .stderr of the directory. */
class RunningProgram
{
public:
  /** @param ignored signal that is ignored when the program starts; 0: none, whatever is ignored here */
  RunningProgram(const TemporaryDirectory &directory, const std::string &arguments,
                 const unsigned int n_processes = 1, const int ignored = 0)
  {
    // exec: the process that we know is the program (or mpirun) itself.
    const std::string command = command_of(directory, arguments, n_processes, "exec ", "");
    process = fork();
    if (process != 0)
      return;
    for (int signal = 1; signal < NSIG; ++signal)
      std::signal(signal, signal == ignored ? SIG_IGN : SIG_DFL);
    execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char *>(nullptr));
    _exit(127);
  }
  ~RunningProgram()
  {
    if (is_running())
    {
      send(SIGKILL);
      wait();
    }
  }
  RunningProgram(const RunningProgram &) = delete;
  RunningProgram &operator=(const RunningProgram &) = delete;

  void send(const int signal) const { kill(process, signal); }

  /** Ids of the processes that it has started: those of mpirun are the ranks, in their order. */
  std::vector<pid_t> children() const
  {
    std::vector<pid_t> found;
    for (const auto &entry : std::filesystem::directory_iterator("/proc"))
      if (status_of(entry.path(), "PPid:") == std::to_string(process))
        found.push_back(std::stoi(entry.path().filename()));
    std::sort(found.begin(), found.end());
    return found;
  }

  /** Whether a process has a handler for @p signal. */
  static bool catches(const pid_t id, const int signal)
  {
    const std::string mask = status_of("/proc/" + std::to_string(id), "SigCgt:");
    return !mask.empty() && ((std::stoull(mask, nullptr, 16) >> (signal - 1)) & 1) != 0;
  }
  bool catches(const int signal) const { return catches(process, signal); }

  /** Lets it have so many seconds of processor time, from its start on, until it gets SIGXCPU. */
  void limit_cpu_time(const rlim_t seconds) const
  {
    const rlimit limit{seconds, RLIM_INFINITY};
    prlimit(process, RLIMIT_CPU, &limit, nullptr);
  }

  /** Lets no file grow beyond this size, in bytes: what a full disk does. */
  void limit_files(const rlim_t largest_size) const
  {
    const rlimit limit{largest_size, largest_size};
    prlimit(process, RLIMIT_FSIZE, &limit, nullptr);
  }

  bool is_running()
  {
    int status = 0;
    if (!exit_code && waitpid(process, &status, WNOHANG) == process)
      note(status);
    return !exit_code;
  }

  /** @return its exit code; 128 + signal if a signal ended it */
  int wait()
  {
    int status = 0;
    if (!exit_code && waitpid(process, &status, 0) == process)
      note(status);
    return *exit_code;
  }

  /** Waits until @p condition holds. @return whether it did before the program ended */
  bool wait_for(const std::function<bool()> &condition)
  {
    while (is_running())
    {
      if (condition())
        return true;
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    return false;
  }

private:
  /** One line of the system's description of a process; empty if it has gone. */
  static std::string status_of(const std::filesystem::path &process, const std::string &name)
  {
    std::ifstream file(process / "status");
    for (std::string word, value; file >> word;)
      if (word == name && file >> value)
        return value;
    return "";
  }

  void note(const int status)
  {
    exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  pid_t process;
  std::optional<int> exit_code;
};
} // namespace Gemmule::Testing
