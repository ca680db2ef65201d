// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/base/rank_zero.h>
#include <gemmule/output/disk.h>
#include <gemmule/output/earlier_results.h>
#include <gemmule/output/output_directory.h>
#include <gemmule/output/output_place.h>
#include <gemmule/parameters/text.h>

#include <algorithm>
#include <filesystem>

namespace Gemmule
{
namespace
{
  /** "'a', 'b' and 7 more" */
  std::string listed(const std::vector<std::string> &names)
  {
    constexpr std::size_t most = 5;
    std::string text;
    for (std::size_t i = 0; i < std::min(most, names.size()); ++i)
      text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + Parameters::in_quotes(names[i]);
    if (names.size() > most)
      text += " and " + std::to_string(names.size() - most) + " more";
    return text;
  }

  void refuse_foreign(const std::string &directory, const EarlierResults &earlier)
  {
    const std::vector<std::string> names = earlier.foreign();
    if (!names.empty())
      throw UserError("The output directory " + Parameters::in_quotes(directory) + " holds " + listed(names) +
                      ", which no run of gemmule has written there and a run would replace. Move " +
                      (names.size() == 1 ? "it" : "them") +
                      " elsewhere, or choose another directory with --output or the parameter 'Output "
                      "directory'.");
  }

  std::string name_of(const std::string &path)
  {
    return path.empty() ? "." : path;
  }
} // namespace

void refuse_to_replace(const std::string &case_file, const std::string &output_directory)
{
  const std::string directory = name_of(output_directory);
  std::error_code ignored;
  if (std::filesystem::equivalent(case_file, directory + "/parameters.prm", ignored) &&
      !EarlierResults(directory).are_of_a_run())
    throw UserError("The run would replace its own parameter file: it writes a listing of all parameters to "
                    "parameters.prm in the output directory '" +
                    directory + "'. Give the file another name, or choose another directory with --output.");
}

std::unique_ptr<DirectoryLock> OutputDirectory::check(const std::string &path, const bool resume)
{
  const std::string directory = name_of(path);
  check_output_place(directory);
  auto lock = DirectoryLock::acquire_existing(directory);
  if (!resume)
    refuse_foreign(directory, EarlierResults(directory));
  return lock;
}

bool OutputDirectory::has_only_begun(const std::string &path)
{
  return EarlierResults(name_of(path)).end_before_first_checkpoint();
}

OutputDirectory::OutputDirectory(const std::string &path, const MPI_Comm &communicator, const bool resume,
                                 std::unique_ptr<DirectoryLock> given_lock)
    : directory(name_of(path)), communicator(communicator), lock(std::move(given_lock))
{
  on_rank_zero(communicator,
               [&]()
               {
                 create_output_place(directory);
                 if (!lock)
                   lock = DirectoryLock::acquire_existing(directory);
                 if (!lock)
                 {
                   // First: the lock marks the directory as that of a run.
                   if (!resume)
                     refuse_foreign(directory, EarlierResults(directory));
                   lock = DirectoryLock::acquire(directory);
                 }
                 if (resume)
                   return;
                 // Once more, now that nobody else changes anything.
                 const EarlierResults earlier(directory);
                 refuse_foreign(directory, earlier);
                 reason_moved = earlier.reason_to_keep();
                 if (reason_moved.empty())
                   earlier.remove();
                 else
                   moved_to = earlier.move_aside();
               });
}

std::string OutputDirectory::move_foreign_files(const unsigned int n_field_files) const
{
  std::string warning;
  on_rank_zero(communicator,
               [&]()
               {
                 std::vector<std::string> names;
                 const std::string folder =
                     EarlierResults(directory).move_foreign_aside(n_field_files, names);
                 if (!folder.empty())
                   warning = "what " + listed(names) +
                             " held is not known as written by a run of gemmule; it is in " + folder +
                             " now.";
               });
  return warning;
}

void OutputDirectory::remove_begun_results() const noexcept
{
  int rank = 0;
  MPI_Comm_rank(communicator, &rank);
  if (rank != 0)
    return;
  try
  {
    if (const EarlierResults begun(directory); begun.end_before_first_checkpoint())
      begun.remove();
  }
  catch (const std::exception &)
  {
    // They stay, then.
  }
}

std::string OutputDirectory::file(const std::string &name) const
{
  return directory + "/" + name;
}

void OutputDirectory::write_parameters(const std::string &parameters) const
{
  on_rank_zero(communicator, [&]() { replace_file(file("parameters.prm"), parameters); });
}
} // namespace Gemmule
