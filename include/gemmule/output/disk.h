// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/output/disk_error.h>

#include <cstdint>
#include <system_error>
#include <vector>

namespace Gemmule
{
/**
 * A file that gets its name when it is complete. Until then it is written under the name with ".part" at the
 * end; whatever goes wrong before removes it, so that nobody takes half a file for a whole one. Only a kill
 * leaves it behind.
 */
class UnfinishedFile
{
public:
  /** Removes what a kill has left of an earlier one. @param path name of the complete file */
  explicit UnfinishedFile(const std::string &path);
  ~UnfinishedFile();
  UnfinishedFile(const UnfinishedFile &) = delete;
  UnfinishedFile &operator=(const UnfinishedFile &) = delete;

  /** Where to write. */
  const std::string &path() const { return unfinished; }

  /**
   * Give it its name, in place of a file that has it.
   *
   * @param durable wait until the content would survive a loss of power
   * @throws DiskError
   */
  void complete(bool durable = false);

private:
  const std::string target, unfinished;
  bool is_complete = false;
};

/** The name that an unfinished file is to have, for messages; any other name as it is. */
std::string complete_name(const std::string &path);

/**
 * Replace the file @p path by @p content as one step, so that a reader or a kill never finds half of it.
 *
 * @param durable wait until it would survive a loss of power
 * @throws DiskError when the disk does not take it
 */
void replace_file(const std::string &path, const std::string &content, bool durable = false);

/** Write everything to the descriptor @p file and close it. @return errno of what has failed, or 0 */
int write_and_close(int file, const std::string &text);

/**
 * Append @p text to the file @p path, which is opened for this only: a file that has been removed or replaced
 * in the meantime does not swallow it.
 *
 * @param create a file that is missing
 * @throws DiskError
 */
void append_to_file(const std::string &path, const std::string &text, bool create);

/**
 * Make sure that @p bytes can be appended to the file @p path (created if missing), and leave that space
 * allocated at its end for whoever writes next. Who truncates the file first gives it back, and knows no more
 * than that there was room a moment ago.
 *
 * HDF5 does not survive a disk that fills up while it writes: the file is left damaged, and the library
 * crashes when the program ends. So the room is taken before it starts.
 *
 * @throws DiskError when there is no room; the file is as it was, and there is none if there was none
 */
void reserve_space(const std::string &path, std::size_t bytes);

/**
 * Wait until the file or directory @p path is on the disk, so that it survives a loss of power.
 * @throws DiskError
 */
void synchronise(const std::string &path);

/** Copy a file. @throws DiskError; @p to is then as it was */
void copy_file(const std::string &from, const std::string &to);

/** Is there something of this name, be it a symbolic link to nothing? Never throws: what is not seen is not
 * there. */
bool exists(const std::string &path) noexcept;

/** Names of the entries of a directory, sorted; @p error says why there are none. Never throws otherwise. */
std::vector<std::string> names_in(const std::string &directory, std::error_code &error);

/** Size and CRC-32 (that of zip and PNG) of a file or a text: what checkpoints recognise damage by. */
struct Checksum
{
  std::uint64_t size = 0;
  std::uint32_t crc = 0;

  static Checksum of_text(const std::string &text);
  /** @throws DiskError when the file cannot be read */
  static Checksum of_file(const std::string &path);

  bool operator==(const Checksum &other) const { return size == other.size && crc == other.crc; }
};
} // namespace Gemmule
