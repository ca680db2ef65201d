#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace Gemmule
{
/**
 * Replace the file @p path by @p content as one step, so that a reader or a kill never finds half of it:
 * written to a neighbouring file that is then renamed.
 *
 * @param durable wait until it would survive a loss of power
 * @throws SimulationError with the path and the remedy when the disk does not take it
 */
void replace_file(const std::string &path, const std::string &content, bool durable = false);

/**
 * Make sure that @p bytes can be appended to the file @p path (created if missing), and leave that space
 * allocated at its end for whoever writes next. Who truncates the file first gives it back, and knows no more
 * than that there was room a moment ago.
 *
 * HDF5 does not survive a disk that fills up while it writes: the file is left damaged, and the library
 * crashes when the program ends. So the room is taken before it starts.
 *
 * @throws SimulationError with the path and the remedy when there is no room; the file is as it was
 */
void reserve_space(const std::string &path, std::size_t bytes);

/**
 * Wait until the file or directory @p path is on the disk, so that it survives a loss of power.
 * @throws SimulationError with the path and the remedy
 */
void synchronise(const std::string &path);

/** Copy a file. @throws SimulationError with the path and the remedy; there is no copy then */
void copy_file(const std::string &from, const std::string &to);

/** Size and CRC-32 (that of zip and PNG) of a file or a text: what checkpoints recognise damage by. */
struct Checksum
{
  std::uint64_t size = 0;
  std::uint32_t crc = 0;

  static Checksum of_text(const std::string &text);
  /** @throws SimulationError when the file cannot be read */
  static Checksum of_file(const std::string &path);

  bool operator==(const Checksum &other) const { return size == other.size && crc == other.crc; }
};
} // namespace Gemmule
