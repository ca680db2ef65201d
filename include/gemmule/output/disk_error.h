// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/exceptions.h>

#include <cstddef>
#include <string>

namespace Gemmule
{
/** What is behind an error of the system, in words for the user. */
struct SystemReason
{
  std::string reason; ///< the end of a sentence, such as "the disk is full"
  std::string remedy; ///< a sentence without its full stop, such as "Make room"
};

/** @param system_error a value of errno; 0 when the system has not said anything */
SystemReason explain(int system_error);

/** Is there too little room for a file of this size: on the disk, in the quota, or by a limit on files? */
bool is_lack_of_room(int system_error);

/**
 * The error to throw when something has failed.
 *
 * @param what for example "Cannot write run/statistics.csv"
 * @param system_error errno of the call that failed, or 0
 */
DiskError disk_error(const std::string &what, int system_error);

/**
 * The errno that writing @p bytes more to the file @p path would have led to most likely, for libraries that
 * do not hand it on: looks at the directory, permissions, free space and limits. 0 if nothing stands in the
 * way.
 */
int likely_error_of_writing(const std::string &path, std::size_t bytes = 0);
} // namespace Gemmule
