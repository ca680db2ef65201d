// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace Gemmule::Parameters
{
/**
 * The text of a parameter file, which may also be a pipe: named, standard input (/dev/stdin) or a process
 * substitution of the shell. What a pipe has given cannot be read a second time; in a parallel run rank 0
 * reads, and the others get the text from it.
 *
 * @throws UserError if there is no such file, if it cannot be read, or if it is too large to be one
 */
std::string read_parameter_file(const std::string &file);
} // namespace Gemmule::Parameters
