#pragma once

#include <gemmule/output/directory_lock.h>

#include <memory>
#include <mpi.h>
#include <string>

namespace Gemmule
{
/**
 * A run writes all its parameters to parameters.prm in its output directory. Where that is the file that a
 * user has written, and no listing of an earlier run, nothing is done.
 * @throws UserError then
 */
void refuse_to_replace(const std::string &case_file, const std::string &output_directory);

/**
 * The directory of the results (design section 4). Construction creates it with its parents, checks that it
 * can be written to and, unless the run is resumed, removes what an earlier run left under the program's own
 * file names, so that nothing stale mixes with the new results. Other files stay. A run that can be
 * continued, because it has a checkpoint and has not finished, is not removed but moved to `earlier-run`,
 * unless that holds such a run already. As long as the object lives no other run can use the directory.
 */
class OutputDirectory
{
public:
  /**
   * Collective.
   *
   * @param path relative to the working directory, or absolute
   * @param lock of the directory, on rank 0, if it has been taken before
   * @throws UserError, naming the path and the remedy, when the directory cannot be created or written to, or
   * when another run uses it
   */
  OutputDirectory(const std::string &path, const MPI_Comm &communicator, bool resume = false,
                  std::unique_ptr<DirectoryLock> lock = nullptr);

  const std::string &path() const { return directory; }

  /** Where an unfinished run has been moved to, on rank 0; empty if there was none. */
  const std::string &earlier_run() const { return moved_to; }

  /** Path of the file @p name in the directory. */
  std::string file(const std::string &name) const;

  /**
   * Write parameters.prm. Collective.
   *
   * @param parameters all values in use, as a parameter file
   */
  void write_parameters(const std::string &parameters) const;

private:
  const std::string directory;
  const MPI_Comm communicator;
  std::unique_ptr<DirectoryLock> lock; ///< on rank 0
  std::string moved_to;
};
} // namespace Gemmule
