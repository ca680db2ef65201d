#include <gemmule/output/checkpoint_directory.h>
#include <gemmule/output/disk.h>
#include <gemmule/output/output_directory.h>
#include <gemmule/output/rank_zero.h>
#include <gemmule/parameters/errors.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <regex>
#include <system_error>
#include <vector>

namespace Gemmule
{
namespace
{
  /** A disk without room is no mistake in the command: the same one will do when there is some. */
  void throw_if_full(const int system_error, const std::string &what)
  {
    if (system_error == ENOSPC || system_error == EDQUOT || system_error == EFBIG)
      throw SimulationError(what + ": is the disk full? Make room and repeat the command.");
  }

  void create(const std::string &directory)
  {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    throw_if_full(error.value(), "Cannot create the output directory '" + directory + "'");
    if (error || !std::filesystem::is_directory(directory))
      throw UserError("Cannot create the output directory '" + directory + "' (" +
                      (error ? error.message() : std::string("there is a file of this name")) +
                      "): choose another one with --output or the parameter 'Output directory'.");
  }

  void check_writable(const std::string &directory)
  {
    const std::string probe = directory + "/.write-test";
    errno = 0;
    std::ofstream file(probe);
    file << "Removed at once." << std::flush;
    const bool is_writable = static_cast<bool>(file);
    const int reason = is_writable ? 0 : errno;
    file.close();
    std::error_code ignored;
    std::filesystem::remove(probe, ignored);
    throw_if_full(reason, "Cannot write to the output directory '" + directory + "'");
    if (!is_writable)
      throw UserError("Cannot write to the output directory '" + directory +
                      "': change its permissions, or choose another one with --output or the parameter "
                      "'Output directory'.");
  }

  /** Is there, besides results, what marks the output directory of a run? */
  bool is_of_a_run(const std::string &directory)
  {
    return std::filesystem::exists(directory + "/parameters.prm") &&
           std::filesystem::exists(directory + "/log.txt");
  }

  bool is_unfinished_run(const std::string &directory)
  {
    if (!is_of_a_run(directory))
      return false;
    std::vector<std::string> complaints;
    const auto checkpoint = CheckpointDirectory(directory).newest_good(complaints);
    return checkpoint && checkpoint->metadata.count("finished") > 0 &&
           checkpoint->metadata.at("finished") != "yes";
  }

  /** Files of an earlier run that the new one writes too. */
  std::vector<std::filesystem::path> earlier_results(const std::string &directory)
  {
    const std::regex ours("statistics\\.csv|interface\\.(h5|xdmf)|solution\\.xdmf|solution-[0-9]{5,}\\.h5|"
                          "(statistics\\.csv|interface\\.(h5|xdmf)|solution\\.xdmf|parameters\\.prm)\\.part");
    std::vector<std::filesystem::path> found;
    for (const auto &entry : std::filesystem::directory_iterator(directory))
      if (std::regex_match(entry.path().filename().string(), ours))
        found.push_back(entry.path());
    return found;
  }

  /** Remove what an earlier run wrote, and nothing else. */
  void remove_earlier_results(const std::string &directory)
  {
    // A folder called checkpoint/ is only ours where the other marks of a run are.
    if (is_of_a_run(directory))
      std::filesystem::remove_all(directory + "/checkpoint");
    for (const auto &path : earlier_results(directory))
      std::filesystem::remove(path);
  }

  /** Move what an earlier run wrote, so that it can be continued where it is then. */
  void move_earlier_results(const std::string &directory, const std::string &target)
  {
    // It may be continued there at this moment.
    std::unique_ptr<DirectoryLock> target_lock;
    if (std::filesystem::is_directory(target))
      target_lock = DirectoryLock::acquire(target);
    if (is_unfinished_run(target))
      throw UserError("Both '" + directory + "' and '" + target +
                      "' hold a run that had not finished. Continue one of them with --resume, move or "
                      "remove '" +
                      target + "', or choose another directory with --output.");
    if (is_of_a_run(target))
      std::filesystem::remove_all(target);
    std::filesystem::create_directory(target);
    auto paths = earlier_results(directory);
    for (const char *name : {"log.txt", "checkpoint", "parameters.prm"})
      paths.push_back(directory + "/" + name);
    for (const auto &path : paths)
      std::filesystem::rename(path, std::filesystem::path(target) / path.filename());
  }
} // namespace

void refuse_to_replace(const std::string &case_file, const std::string &output_directory)
{
  const std::string directory = output_directory.empty() ? "." : output_directory;
  std::error_code ignored;
  if (!is_of_a_run(directory) &&
      std::filesystem::equivalent(case_file, directory + "/parameters.prm", ignored))
    throw UserError("The run would replace its own parameter file: it writes a listing of all parameters to "
                    "parameters.prm in the output directory '" +
                    directory + "'. Give the file another name, or choose another directory with --output.");
}

OutputDirectory::OutputDirectory(const std::string &path, const MPI_Comm &communicator, const bool resume,
                                 std::unique_ptr<DirectoryLock> given_lock)
    : directory(path.empty() ? "." : path), communicator(communicator), lock(std::move(given_lock))
{
  on_rank_zero(communicator,
               [&]()
               {
                 create(directory);
                 if (!lock)
                   lock = DirectoryLock::acquire(directory);
                 check_writable(directory);
                 if (resume)
                   return;
                 try
                 {
                   if (is_unfinished_run(directory))
                   {
                     moved_to = directory + "/earlier-run";
                     move_earlier_results(directory, moved_to);
                   }
                   remove_earlier_results(directory);
                 }
                 catch (const std::filesystem::filesystem_error &error)
                 {
                   throw UserError("Cannot remove or move the results of an earlier run (" +
                                   std::string(error.what()) + "): choose another directory with --output.");
                 }
               });
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
