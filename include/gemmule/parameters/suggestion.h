// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace Gemmule::Parameters
{
/**
 * Number of letters to insert, delete, replace or swap with their neighbour to turn one word into another
 * (restricted Damerau-Levenshtein distance); upper and lower case count as equal.
 */
unsigned int edit_distance(const std::string &a, const std::string &b);

/** The candidate closest to @p word, or an empty string if none is close enough to be a slip of the pen. */
std::string nearest(const std::string &word, const std::vector<std::string> &candidates);
} // namespace Gemmule::Parameters
