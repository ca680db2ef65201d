// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/linear_solver.h>
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/parameters/all_parameters.h>

#include <mpi.h>
#include <string>
#include <vector>

namespace Gemmule
{
/** What can be said against a case before its first step, although it can be computed. */
template <int dim>
std::vector<std::string> warnings_before_start(const CoupledSystem<dim> &system);

/** A solver and its memory in words. Collective. */
std::string describe(const LinearSolver::Report &solver, MPI_Comm communicator);

/** What --check finds. */
struct CaseCheck
{
  std::vector<std::string> warnings;
  /** Cells, unknowns, solver and memory of the start, and the memory of the largest mesh that is allowed. */
  std::string size;
};

/**
 * Checks what needs more than the parameters themselves: the initial membrane, and its first flow.
 * Collective.
 * @throws UserError, SimulationError
 */
template <int dim>
CaseCheck check_case(const AllParameters &parameters, MPI_Comm communicator);
} // namespace Gemmule
