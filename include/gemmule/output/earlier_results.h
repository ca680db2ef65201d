// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/output/result_files.h>

#include <functional>
#include <string>
#include <vector>

namespace Gemmule
{
/**
 * What is in an output directory before a run begins or goes on there. It decides what may be replaced:
 * results of a run that has finished. All others are moved to a folder `earlier-run`, `earlier-run-2` and so
 * on in the directory. What no run of gemmule has written is neither overwritten nor removed.
 *
 * Works on one rank, under the lock of the directory; what has changed since construction is not noticed.
 */
class EarlierResults
{
public:
  /** Looks, and changes nothing. A directory that does not exist or cannot be read has no results. */
  explicit EarlierResults(const std::string &directory);

  /** Has a run of gemmule begun here? It has left its lock, or its parameters and its log. */
  bool are_of_a_run() const;

  /** Names that a new run would write and that no run has written here. */
  std::vector<std::string> foreign() const;

  /**
   * Why they may not be replaced: the end of a sentence that begins with "a run that", such as "had not
   * finished". Empty if the run has come to its end, its last checkpoint is of that end and nothing is
   * damaged, or if there are no results.
   */
  std::string reason_to_keep() const;

  /** Has a run ended here before it could complete its first checkpoint, and with it before its first step?
   */
  bool end_before_first_checkpoint() const;

  /** Removes what a run has written. @throws UserError */
  void remove() const;

  /**
   * Moves all results to a new folder.
   * @return its path
   * @throws UserError; the results are then where they were
   */
  std::string move_aside() const;

  /**
   * Moves to a new folder what is not known as written by a run, and what a resumed run would overwrite or
   * remove.
   *
   * @param n_field_files number of solution-NNNNN.h5 that stay as they are
   * @param names gets what was moved
   * @return path of the folder; empty if there was nothing to move
   */
  std::string move_foreign_aside(unsigned int n_field_files, std::vector<std::string> &names) const;

private:
  struct Entry
  {
    std::string name;
    ResultKind kind;
    Origin origin;
  };

  const Entry *find(const std::string &name) const;
  /** Is there anything that took computing? */
  bool hold_results() const;
  std::string move(const std::function<bool(const Entry &)> &is_wanted,
                   std::vector<std::string> &names) const;

  const std::string directory;
  std::vector<Entry> entries;
};
} // namespace Gemmule
