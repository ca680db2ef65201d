// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>
#include <string>

namespace Gemmule
{
/**
 * The memory in bytes that is left on this machine: what is free (MemAvailable of Linux), or what the control
 * groups of this process (containers, batch systems) leave of it. Infinite where the system does not tell.
 * @param root in front of the names of the system's files: for tests
 */
double memory_left_on_machine(const std::string &root = "");

/** What the limit of this process's address space (ulimit -v) leaves, in bytes; infinite without a limit. */
double address_space_left();

/** A need of memory in bytes, and what there is for it. */
struct MemoryBudget
{
  double needed, left;
  bool suffices() const { return needed <= left; }
};

/**
 * The machine or process for which there is least, the same on all processes.
 * @param touched memory that this process will write to, in bytes: those on one machine share what is left
 * @param reserved memory that this process will ask for. Collective.
 */
MemoryBudget scarcest_memory(double touched, double reserved, MPI_Comm communicator);
} // namespace Gemmule
