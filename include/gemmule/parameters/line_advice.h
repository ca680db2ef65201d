// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/parameters/schema.h>

#include <string>

namespace Gemmule::Parameters
{
/**
 * What to do about a line of a parameter file that begins with none of the keywords: the nearest keyword, or
 * the one that is missing.
 *
 * @param section in which the line stands
 * @return sentences that go on after "the line '...' cannot be understood."
 */
std::string advice_for_line(const std::string &line, const std::string &section, const Schema &schema);
} // namespace Gemmule::Parameters
