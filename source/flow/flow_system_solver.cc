// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/mumps_solver.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/flow/flow_system_solver.h>
#include <gemmule/flow/iterative_flow_solver.h>

#include <deal.II/base/mpi.h>

namespace Gemmule
{
using namespace dealii;

FlowSystemSolver::FlowSystemSolver(const MPI_Comm communicator, const unsigned int dimension,
                                   const Parameters::Flow &parameters)
    : communicator(communicator), dimension(dimension), parameters(parameters)
{
}

FlowSystemSolver::~FlowSystemSolver() = default;

bool FlowSystemSolver::is_iterative(const Parameters::FlowSolver choice, const unsigned int dimension,
                                    const Index n_unknowns, const unsigned int n_ranks)
{
  // Measured (doc/performance.md). In 3D iterations are faster for 1556 unknowns already, which is about the
  // smallest mesh that holds a membrane. In 2D factors are dear for large meshes only; more ranks help less
  // with them than with iterations.
  const Index crossover_in_2d = n_ranks == 1 ? 400000 : 300000;
  switch (choice)
  {
  case Parameters::FlowSolver::direct:
    return false;
  case Parameters::FlowSolver::iterative:
    return true;
  default:
    return dimension == 3 || n_unknowns > crossover_in_2d;
  }
}

MumpsSolver &FlowSystemSolver::direct_solver()
{
  if (direct == nullptr)
    direct = std::make_unique<MumpsSolver>(
        communicator, /*symmetric =*/true,
        dimension == 3 ? MumpsSolver::Ordering::pord : MumpsSolver::Ordering::approximate_minimum_degree);
  return *direct;
}

void FlowSystemSolver::prepare(const SubassembledMatrix &matrix, const BlockNumbering &numbering,
                               const Index fixed)
{
  system = {&matrix, &numbering, fixed};
  reason_of_fall_back.clear();
  uses_iterations = is_iterative(parameters.solver, dimension, numbering.size(),
                                 Utilities::MPI::n_mpi_processes(communicator));
  if (!uses_iterations)
  {
    iterative.reset();
    direct_solver().prepare(matrix, numbering, fixed);
    return;
  }
  direct.reset(); // its factors are large
  if (iterative == nullptr)
    iterative = std::make_unique<IterativeFlowSolver>(parameters.solver_tolerance,
                                                      parameters.largest_number_of_iterations);
  iterative->set_structure_source(find_structure);
  iterative->prepare(matrix, numbering, fixed);
}

void FlowSystemSolver::solve(const std::vector<Vector> &right_sides, std::vector<Vector> &solutions)
{
  if (!uses_iterations)
  {
    direct->solve(right_sides, solutions);
    return;
  }
  try
  {
    iterative->solve(right_sides, solutions);
  }
  catch (const NoConvergence &failure)
  {
    fall_back(failure.what(), right_sides, solutions);
  }
}

void FlowSystemSolver::fall_back(const std::string &failure, const std::vector<Vector> &right_sides,
                                 std::vector<Vector> &solutions)
{
  iterative.reset();
  try
  {
    direct_solver().prepare(*system.matrix, *system.numbering, system.fixed);
  }
  catch (const SimulationError &error)
  {
    throw SimulationError(failure + " The direct solver cannot help: " + error.what());
  }
  uses_iterations = false;
  reason_of_fall_back = failure;
  direct->solve(right_sides, solutions);
}

LinearSolver::Report FlowSystemSolver::report() const
{
  Report report = uses_iterations ? iterative->report() : direct->report();
  if (!reason_of_fall_back.empty())
    report.warning = reason_of_fall_back + " This flow was solved directly instead.";
  return report;
}
} // namespace Gemmule
