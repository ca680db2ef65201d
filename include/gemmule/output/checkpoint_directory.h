// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/output/disk.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace Gemmule
{
/**
 * The numbered checkpoints below `checkpoint/` in the directory of the results (doc/checkpoints.md): knows
 * what is on the disk, not what a checkpoint means.
 *
 * A checkpoint is a directory `NNNNN` with files and `metadata.txt`, which lists their sizes and checksums,
 * carries one of its own, and is written last: whatever interrupts the writing, a checkpoint is either
 * complete or recognised as incomplete, and earlier ones are not touched before it is complete.
 *
 * Works on one rank; see on_rank_zero(). Nothing is cached: what others do to the directory is noticed.
 */
class CheckpointDirectory
{
public:
  /** What metadata.txt says apart from the files, by name. Values are single lines. */
  using Metadata = std::map<std::string, std::string>;

  // Names of the files.
  static constexpr const char *state_file = "state.h5", *membrane_file = "interface.h5",
                              *parameter_file = "parameters.prm", *metadata_file = "metadata.txt";

  struct Checkpoint
  {
    unsigned int number;
    std::string path; ///< of its directory
    Metadata metadata;
  };

  /** Creates nothing. @param results directory of the results */
  explicit CheckpointDirectory(const std::string &results);

  /**
   * The newest checkpoint whose files are all as they were written.
   *
   * @param complaints gets a line for every newer one: its path, and what is wrong with it
   */
  std::optional<Checkpoint> newest_good(std::vector<std::string> &complaints) const;

  /**
   * Starts a new checkpoint. @return path of its directory, in which the caller then puts files
   * @throws DiskError
   */
  std::string begin();

  /**
   * Completes the checkpoint that begin() started, then removes all but the last @p number_kept complete
   * ones.
   *
   * @param damaged numbers of checkpoints that do not count, because they turned out to be damaged
   * @throws DiskError; abandon() then
   */
  void complete(const Metadata &metadata, unsigned int number_kept,
                const std::vector<unsigned int> &damaged = {});

  /** Removes what begin() started. Never throws. */
  void abandon() noexcept;

  /** Removes all checkpoints, and nothing else. Never throws: what stays takes space only. */
  void remove_all() const noexcept;

  /** Numbers of the checkpoints on disk, complete or not, in ascending order. */
  std::vector<unsigned int> numbers() const;

  /** Was the checkpoint written to its end? Whether it is still as it was is another question. */
  bool is_complete(unsigned int number) const;

  /** Is there one that was written to its end? */
  bool has_complete() const;

private:
  std::string path_of(unsigned int number) const;
  /** Also checks the files. @throws SimulationError that says what is wrong */
  Metadata read(unsigned int number) const;
  /** Removes the files of a checkpoint; what others have put beside them stays, with its folder. */
  void remove(unsigned int number) const noexcept;

  const std::string directory;
  std::optional<unsigned int> in_work;
};
} // namespace Gemmule
