// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

namespace Gemmule::Testing
{
/** A directory that the program is run in. */
struct Directory
{
  explicit Directory(const std::filesystem::path &path) : path(path) {}

  std::string file(const std::string &name) const { return (path / name).string(); }
  /** Writes a file and returns its path. */
  std::string write(const std::string &name, const std::string &text) const
  {
    std::ofstream(path / name) << text;
    return file(name);
  }
  std::string read(const std::string &name) const
  {
    std::ifstream stream(path / name);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  std::filesystem::path path;
};

/** One that vanishes with the object. */
class TemporaryDirectory : public Directory
{
public:
  TemporaryDirectory() : Directory(make()) {}
  ~TemporaryDirectory()
  {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory &) = delete;
  TemporaryDirectory &operator=(const TemporaryDirectory &) = delete;

private:
  static std::string make()
  {
    std::string pattern = (std::filesystem::temp_directory_path() / "gemmule-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw std::runtime_error("cannot create a temporary directory");
    return pattern;
  }
};

struct Result
{
  int exit_code;
  std::string out, err;
};

/**
 * The command that starts the executable with arguments in shell syntax, on one process or under mpirun. The
 * environment is a clean one, except for the sanitizers' options and what makes Open MPI start quickly: that
 * of an MPI program, as the tests are, would confuse another. Output goes to .stdout and .stderr of @p
 * directory.
 */
inline std::string command_of(const Directory &directory, const std::string &arguments,
                              const unsigned int n_processes, const std::string &before,
                              const std::string &prefix)
{
  const std::string launcher =
      n_processes == 1 ? "" : "mpirun --oversubscribe -n " + std::to_string(n_processes) + " ";
  return "cd '" + directory.path.string() + "' && " + before +
         "env -i PATH=\"$PATH\" HOME=\"$HOME\" OMPI_ALLOW_RUN_AS_ROOT=1 "
         "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_NUM_THREADS=1 DEAL_II_NUM_THREADS=1 "
         "${OMPI_MCA_pml:+OMPI_MCA_pml=$OMPI_MCA_pml} ${OMPI_MCA_btl:+OMPI_MCA_btl=$OMPI_MCA_btl} "
         "ASAN_OPTIONS=\"$ASAN_OPTIONS\" LSAN_OPTIONS=\"$LSAN_OPTIONS\" UBSAN_OPTIONS=\"$UBSAN_OPTIONS\" " +
         prefix + launcher + GEMMULE_EXECUTABLE + " " + arguments + " > .stdout 2> .stderr";
}

/**
 * Runs the executable in @p directory with arguments in shell syntax, on one process or under mpirun.
 * @param prefix of the command, for example "timeout 60 "
 */
inline Result run_gemmule(const Directory &directory, const std::string &arguments,
                          const unsigned int n_processes = 1, const std::string &prefix = "")
{
  const std::string command = command_of(directory, arguments, n_processes, "", prefix);
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, directory.read(".stdout"),
          directory.read(".stderr")};
}
} // namespace Gemmule::Testing
