// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace Gemmule::Parameters
{
/**
 * What is wrong with the name of a directory, as far as its text shows: a shell would have put something else
 * in its place ('~', '$HOME', '`date`', '*'), it stands in quotation marks, it begins with '-' or a blank,
 * holds backslashes or control characters, or is empty. The file system takes most of these names, and the
 * user finds a directory of a strange name later, or does not find the results.
 *
 * @return the end of a sentence that begins with the name of the parameter, and the remedy; empty if all is
 * well
 */
std::string flaw_of_directory_name(const std::string &name);
} // namespace Gemmule::Parameters
