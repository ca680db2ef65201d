// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/parameters/parameter_file.h>

#include <cerrno>
#include <cstdint>
#include <fcntl.h>
#include <filesystem>
#include <system_error>
#include <unistd.h>

namespace Gemmule::Parameters
{
namespace
{
  // A file with every parameter and its description has 20 kB.
  constexpr std::uintmax_t largest_file = 10 * 1024 * 1024;

  /** An open file that is closed with the object. */
  class Descriptor
  {
  public:
    /** Standard input is open already; a socket, which some launchers make of it, cannot be opened by a name.
     */
    explicit Descriptor(const std::string &file)
        : number(file == "/dev/stdin" ? dup(STDIN_FILENO) : open(file.c_str(), O_RDONLY | O_CLOEXEC))
    {
    }
    ~Descriptor()
    {
      if (number >= 0)
        close(number);
    }
    Descriptor(const Descriptor &) = delete;
    Descriptor &operator=(const Descriptor &) = delete;

    const int number;
  };

  [[noreturn]] void refuse_size(const std::string &file)
  {
    throw UserError("'" + file + "' is larger than " + std::to_string(largest_file / 1024 / 1024) +
                    " MB and no parameter file. Give the parameter file (*.prm), which is plain text.");
  }

  bool is_descriptor(const std::string &file)
  {
    return file.rfind("/dev/fd/", 0) == 0 || file.rfind("/proc/self/fd/", 0) == 0;
  }
} // namespace

std::string read_parameter_file(const std::string &file)
{
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  if (!std::filesystem::exists(status) && is_descriptor(file))
    throw UserError("the parameter file '" + file +
                    "' does not exist: mpirun does not hand on the pipes of the shell. Put the text into a "
                    "file, or give it to the standard input of mpirun and name /dev/stdin as the file.");
  if (!std::filesystem::exists(status))
    throw UserError("the parameter file '" + file +
                    "' does not exist. Check the path; 'gemmule --print-parameters' "
                    "prints a file to start from.");
  if (std::filesystem::is_directory(status))
    throw UserError("'" + file + "' is a directory. Give the parameter file (*.prm) itself.");
  // Reading some devices would never end.
  if (std::filesystem::is_character_file(status) || std::filesystem::is_block_file(status))
    throw UserError("'" + file + "' is a device. Give a parameter file (*.prm), which is plain text.");
  if (std::filesystem::is_regular_file(status) && std::filesystem::file_size(file, ignored) > largest_file)
    refuse_size(file);

  const Descriptor descriptor(file);
  if (descriptor.number < 0)
    throw UserError("the parameter file '" + file + "' cannot be read. Check its permissions.");
  std::string text;
  char buffer[65536];
  while (true)
  {
    const ssize_t n = read(descriptor.number, buffer, sizeof(buffer));
    if (n < 0 && errno == EINTR)
      continue;
    if (n < 0)
      throw UserError("reading the parameter file '" + file + "' failed (" +
                      std::generic_category().message(errno) +
                      "). Copy it to another place, or repeat the command.");
    if (n == 0)
      return text;
    text.append(buffer, n);
    // A pipe has no size that could be looked at before.
    if (text.size() > largest_file)
      refuse_size(file);
  }
}
} // namespace Gemmule::Parameters
