// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>
#include <string>

namespace Gemmule
{
/**
 * Makes an error that one process has found an error of all. A process that throws alone leaves the others
 * waiting for it in their next communication. Collective.
 *
 * @param parameter full name, as for ParameterError; the same on all processes
 * @param complaint what this process has found, or nothing
 * @throws ParameterError on all processes if one of them has a complaint: that of the lowest such process
 */
void raise_together(const std::string &parameter, const std::string &complaint, MPI_Comm communicator);
} // namespace Gemmule
