// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

namespace Gemmule
{
/**
 * Whether all processes of @p communicator call this within @p seconds (of wall clock) of each other. A
 * process that failed alone leaves the others waiting in a communication that never completes, and must not
 * enter another one that waits for them. Where the answer is no on one process the communicator is of no use
 * any more.
 */
bool all_processes_arrive(MPI_Comm communicator, double seconds = 10.);
} // namespace Gemmule
