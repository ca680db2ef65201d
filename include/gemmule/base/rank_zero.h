// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <mpi.h>

namespace Gemmule
{
/**
 * Run @p action on rank 0 alone and wait for it on all ranks; what it throws is thrown on every rank (the
 * kinds of base/exceptions.h, DiskError and std::bad_alloc keep their kind, anything else becomes a
 * SimulationError). Without this a full disk would stop rank 0 and leave the others waiting for ever.
 * Collective.
 */
void on_rank_zero(const MPI_Comm &communicator, const std::function<void()> &action);
} // namespace Gemmule
