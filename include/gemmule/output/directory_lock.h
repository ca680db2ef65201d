// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <memory>
#include <string>

namespace Gemmule
{
/**
 * Keeps a second run out of a directory of results: an advisory lock (flock) on the file ".lock" in it. The
 * system releases it when the process ends, however it ends, so that nothing has to be cleaned up after a
 * kill; the file itself stays. On a file system without locks there is no protection.
 *
 * For the one process that writes: not collective.
 */
class DirectoryLock
{
public:
  /**
   * Locks a directory that exists.
   * @throws UserError with the process that holds the lock and the remedy, if there is one
   */
  static std::unique_ptr<DirectoryLock> acquire(const std::string &directory);

  /** The same, but nothing if no run has ever locked the directory: it writes nothing. */
  static std::unique_ptr<DirectoryLock> acquire_existing(const std::string &directory);

  ~DirectoryLock();
  DirectoryLock(const DirectoryLock &) = delete;
  DirectoryLock &operator=(const DirectoryLock &) = delete;

private:
  DirectoryLock(const std::string &directory, int file);

  const int file; ///< descriptor; negative where files cannot be locked
};
} // namespace Gemmule
