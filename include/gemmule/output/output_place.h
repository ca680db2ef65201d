// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace Gemmule
{
/**
 * Can the directory be used, or created, for results? Creates nothing that stays, so that a mistake found
 * later leaves no trace. For one rank.
 * @throws UserError with the directory, the reason and the remedy, or DiskError when there is no room
 */
void check_output_place(const std::string &directory);

/** Creates the directory with those above it, as far as they do not exist. @throws as check_output_place() */
void create_output_place(const std::string &directory);
} // namespace Gemmule
