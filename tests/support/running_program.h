#pragma once

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
  RunningProgram(const TemporaryDirectory &directory, const std::string &arguments,
                 const unsigned int n_processes = 1)
  {
    // exec: the process that we know is the program (or mpirun) itself.
    const std::string command = command_of(directory, arguments, n_processes, "exec ", "");
    process = fork();
    if (process != 0)
      return;
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
  void note(const int status)
  {
    exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

  pid_t process;
  std::optional<int> exit_code;
};
} // namespace Gemmule::Testing
