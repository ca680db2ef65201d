#include <gemmule/output/disk.h>
#include <gemmule/output/output_directory.h>
#include <gemmule/output/rank_zero.h>
#include <gemmule/parameters/errors.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <system_error>
#include <vector>

namespace Gemmule
{
namespace
{
  void create(const std::string &directory)
  {
    std::error_code error;
    std::filesystem::create_directories(directory, error);
    if (error || !std::filesystem::is_directory(directory))
      throw UserError("Cannot create the output directory '" + directory + "' (" +
                      (error ? error.message() : std::string("there is a file of this name")) +
                      "): choose another one with --output or the parameter 'Output directory'.");
  }

  void check_writable(const std::string &directory)
  {
    const std::string probe = directory + "/.write-test";
    std::ofstream file(probe);
    file << "Removed at once." << std::flush;
    const bool is_writable = static_cast<bool>(file);
    file.close();
    std::error_code ignored;
    std::filesystem::remove(probe, ignored);
    if (!is_writable)
      throw UserError("Cannot write to the output directory '" + directory +
                      "': free some space or change its permissions, or choose another one with --output or "
                      "the parameter 'Output directory'.");
  }

  /** Remove what an earlier run wrote, and nothing else. */
  void remove_earlier_results(const std::string &directory)
  {
    // A folder called checkpoint/ is only ours where the other marks of a run are.
    if (std::filesystem::exists(directory + "/parameters.prm") &&
        std::filesystem::exists(directory + "/log.txt"))
      std::filesystem::remove_all(directory + "/checkpoint");

    const std::regex ours("statistics\\.csv|interface\\.(h5|xdmf)|solution\\.xdmf|solution-[0-9]{5,}\\.h5|"
                          "(statistics\\.csv|interface\\.(h5|xdmf)|solution\\.xdmf|parameters\\.prm)\\.part");
    std::vector<std::filesystem::path> stale;
    for (const auto &entry : std::filesystem::directory_iterator(directory))
      if (std::regex_match(entry.path().filename().string(), ours))
        stale.push_back(entry.path());
    for (const auto &path : stale)
      std::filesystem::remove(path);
  }
} // namespace

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
                   remove_earlier_results(directory);
                 }
                 catch (const std::filesystem::filesystem_error &error)
                 {
                   throw UserError("Cannot remove the results of an earlier run (" +
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
