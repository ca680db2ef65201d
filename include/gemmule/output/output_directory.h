// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/output/directory_lock.h>

#include <memory>
#include <mpi.h>
#include <string>
#include <vector>

namespace Gemmule
{
/**
 * A run writes all its parameters to parameters.prm in its output directory. Where that is the file that a
 * user has written, and no listing of an earlier run, nothing is done.
 * @throws UserError then
 */
void refuse_to_replace(const std::string &case_file, const std::string &output_directory);

/**
 * The directory of the results. Construction creates it with its parents, checks that it can be written to
 * and, unless the run is resumed, makes room for new results (EarlierResults): those of a run that has
 * finished are removed, others are moved to a folder in the directory. Files that no run has written stay;
 * where they have names of results the run is refused. As long as the object lives no other run can use the
 * directory.
 */
class OutputDirectory
{
public:
  /**
   * What can be known before anything is computed: finds the mistakes that construction would find, and
   * changes nothing. For one rank.
   *
   * @return the lock, if a run has used the directory before
   * @throws UserError or DiskError, as the constructor
   */
  static std::unique_ptr<DirectoryLock> check(const std::string &path, bool resume);

  /**
   * Has a run been here that ended before its first checkpoint? There is nothing to resume then, and nothing
   * lost when it begins anew. For one rank, which holds the lock.
   */
  static bool has_only_begun(const std::string &path);

  /**
   * Collective.
   *
   * @param path relative to the working directory, or absolute
   * @param lock of the directory, on rank 0, if it has been taken before
   * @throws UserError, naming the path and the remedy, when the directory cannot be created or written to,
   * when another run uses it, or when files in it would be overwritten that no run has written; DiskError
   * when the disk is full
   */
  OutputDirectory(const std::string &path, const MPI_Comm &communicator, bool resume = false,
                  std::unique_ptr<DirectoryLock> lock = nullptr);

  const std::string &path() const { return directory; }

  /** Where earlier results have been moved to, on rank 0; empty if there were none. */
  const std::string &earlier_run() const { return moved_to; }
  /** And why: the end of a sentence that begins with "a run that". */
  const std::string &reason_of_move() const { return reason_moved; }

  /**
   * Before a resumed run goes on: moves out of its way what is not recognised as written by a run.
   * Collective.
   *
   * @param n_field_files number of solution-NNNNN.h5 that stay as they are
   * @return a warning for the log, on rank 0; empty if nothing was moved
   */
  std::string move_foreign_files(unsigned int n_field_files) const;

  /**
   * For a run that cannot go on: removes its results if it has not come to its first checkpoint, so that they
   * do not take room that is missing. Never throws; does nothing on ranks other than 0.
   */
  void remove_begun_results() const noexcept;

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
  std::string moved_to, reason_moved;
};
} // namespace Gemmule
