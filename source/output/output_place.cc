// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/output/disk.h>
#include <gemmule/output/output_place.h>
#include <gemmule/parameters/text.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

namespace Gemmule
{
namespace
{
  namespace fs = std::filesystem;

  const std::string choose = "choose another one with --output or the parameter 'Output directory'.";

  /** Below the directory: earlier-run-99/checkpoint/000000001/parameters.prm.part, and some more. */
  constexpr std::size_t length_of_names_in_it = 96;

  std::string named(const std::string &directory)
  {
    return "the output directory " + Parameters::in_quotes(directory);
  }

  [[noreturn]] void cannot_create(const std::string &directory, const std::string &reason)
  {
    throw UserError("Cannot create " + named(directory) + " (" + reason + "): " + choose);
  }

  [[noreturn]] void cannot_create(const std::string &directory, const int error)
  {
    if (is_lack_of_room(error))
      throw disk_error("Cannot create " + named(directory), error);
    cannot_create(directory, std::generic_category().message(error));
  }

  [[noreturn]] void cannot_write(const std::string &directory, const int error)
  {
    if (is_lack_of_room(error))
      throw disk_error("Cannot write to " + named(directory), error);
    if (error == EACCES || error == EPERM)
      throw UserError("Cannot write to " + named(directory) + ": change its permissions, or " + choose);
    throw UserError("Cannot write to " + named(directory) + " (" + std::generic_category().message(error) +
                    "): " + choose);
  }

  /** stat(). @return errno, or 0 */
  int look_at(const std::string &path, struct stat &status)
  {
    return stat(path.c_str(), &status) == 0 ? 0 : errno;
  }

  void check_lengths(const std::string &directory)
  {
    for (const fs::path &component : fs::path(directory))
      if (component.native().size() > NAME_MAX)
        cannot_create(directory, "a name in it has " + std::to_string(component.native().size()) +
                                     " bytes, " + std::to_string(NAME_MAX) + " are the most");
    if (directory.size() + length_of_names_in_it > PATH_MAX)
      cannot_create(directory, "it has " + std::to_string(directory.size()) + " bytes, " +
                                   std::to_string(PATH_MAX - length_of_names_in_it) + " are the most");
  }

  /** The directory, or where it does not exist the last one above it that does. */
  std::string existing_part(const std::string &directory)
  {
    fs::path place(directory);
    while (true)
    {
      struct stat status = {};
      const std::string path = place.empty() ? "." : place.native();
      const int error = look_at(path, status);
      if (error == 0 && S_ISDIR(status.st_mode))
        return path;
      if (error == 0)
        cannot_create(directory, ENOTDIR);
      if (error == EACCES || error == ELOOP)
        throw UserError(
            "Cannot reach " + named(directory) + " (" + std::generic_category().message(error) + "): " +
            (error == ELOOP ? "remove the loop, or " : "change the permissions above it, or ") + choose);
      if (error != ENOENT)
        cannot_create(directory, error);
      if (exists(path))
        cannot_create(directory, "'" + path + "' is a symbolic link to something that does not exist");
      // "a/b/" is the empty name in "a/b".
      place = place.has_relative_path() ? place.parent_path() : fs::path("/");
    }
  }

  /** Tries to write a file in a directory that exists. @return errno, or 0 */
  int try_to_write(const std::string &directory)
  {
    std::string name = directory + "/.gemmule-XXXXXX";
    const int file = mkstemp(name.data());
    if (file < 0)
      return errno;
    const int error = write_and_close(file, "Removed at once.");
    unlink(name.c_str());
    return error;
  }

  /** Tries to create a directory in one that exists. @return errno, or 0 */
  int try_to_create(const std::string &directory)
  {
    std::string name = directory + "/.gemmule-XXXXXX";
    if (mkdtemp(name.data()) == nullptr)
      return errno;
    rmdir(name.c_str());
    return 0;
  }
} // namespace

void check_output_place(const std::string &directory)
{
  check_lengths(directory);
  const std::string existing = existing_part(directory);
  struct stat status = {};
  if (look_at(directory, status) != 0)
  {
    if (const int error = try_to_create(existing); error != 0)
      cannot_create(directory, error);
    return;
  }
  if (const int error = try_to_write(directory); error != 0)
    cannot_write(directory, error);
  std::error_code error;
  names_in(directory, error);
  if (error)
    throw UserError("Cannot read " + named(directory) + " (" + error.message() +
                    "): change its permissions, or " + choose);
}

void create_output_place(const std::string &directory)
{
  check_lengths(directory);
  existing_part(directory);
  std::error_code error, ignored;
  fs::create_directories(directory, error);
  if (error)
    cannot_create(directory, error.value());
  if (!fs::is_directory(directory, ignored))
    cannot_create(directory, ENOTDIR);
  check_output_place(directory);
}
} // namespace Gemmule
