// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/flow_linear_solver.h>
#include <gemmule/parameters/discretisation.h>

#include <memory>
#include <string>
#include <vector>

namespace Gemmule
{
class IterativeFlowSolver;
class MumpsSolver;

/**
 * Solves the equations of the flow directly or iteratively, as the parameter 'Flow discretisation/Solver'
 * says: 'automatic' takes whatever is faster by measurement (doc/performance.md). Where the iterations do not
 * converge it solves directly instead, if the memory allows that.
 */
class FlowSystemSolver : public FlowLinearSolver
{
public:
  /** @param dimension of space @param parameters which solver, and the tolerance of the iterative one */
  FlowSystemSolver(MPI_Comm communicator, unsigned int dimension, const Parameters::Flow &parameters);
  ~FlowSystemSolver() override;

  void prepare(const SubassembledMatrix &matrix, const BlockNumbering &numbering, Index fixed) override;
  /** @throws SimulationError on all ranks where neither solver finds the solution */
  void solve(const std::vector<Vector> &right_sides, std::vector<Vector> &solutions) override;
  Report report() const override;

  /** Is a system of that size solved iteratively? */
  static bool is_iterative(Parameters::FlowSolver choice, unsigned int dimension, Index n_unknowns,
                           unsigned int n_ranks);

private:
  MumpsSolver &direct_solver();
  /** Solves directly because of @p failure of the iterations. */
  void fall_back(const std::string &failure, const std::vector<Vector> &right_sides,
                 std::vector<Vector> &solutions);

  const MPI_Comm communicator;
  const unsigned int dimension;
  const Parameters::Flow parameters;
  std::unique_ptr<MumpsSolver> direct; ///< made when it is needed first
  std::unique_ptr<IterativeFlowSolver> iterative;

  /** Of the last prepare(). */
  struct System
  {
    const SubassembledMatrix *matrix = nullptr;
    const BlockNumbering *numbering = nullptr;
    Index fixed = dealii::numbers::invalid_dof_index;
  };
  System system;
  bool uses_iterations = false;
  std::string reason_of_fall_back; ///< empty: none
};
} // namespace Gemmule
