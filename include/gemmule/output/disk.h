#pragma once

#include <cstddef>
#include <string>

namespace Gemmule
{
/**
 * Replace the file @p path by @p content as one step, so that a reader or a kill never finds half of it:
 * written to a neighbouring file that is then renamed.
 *
 * @throws SimulationError with the path and the remedy when the disk does not take it
 */
void replace_file(const std::string &path, const std::string &content);

/**
 * Make sure that @p bytes can be appended to the file @p path (created if missing), and leave that space
 * allocated at its end for whoever writes next.
 *
 * HDF5 does not survive a disk that fills up while it writes: the file is left damaged, and the library
 * crashes when the program ends. So the room is taken before it starts.
 *
 * @throws SimulationError with the path and the remedy when there is no room; the file is as it was
 */
void reserve_space(const std::string &path, std::size_t bytes);
} // namespace Gemmule
