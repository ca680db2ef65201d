// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/exceptions.h>
#include <gemmule/flow/flow_linear_solver.h>

#include <memory>
#include <vector>

namespace Gemmule
{
/** The iterations of a linear solver do not reach the tolerance. */
class NoConvergence : public SimulationError
{
public:
  using SimulationError::SimulationError;
};

/**
 * Solves the equations of the flow by FGMRES with a block triangular preconditioner (doc/method-flow.md):
 *
 *   z_p = -S^-1 r_p,  z_e = D_e^-1 r_e,  z_u = A^-1 (r_u - B^T z_p - E^T z_e).
 *
 * A^-1 is a TwoLevelCycle for each component of the velocity, with one matrix for all of them. S is the mass
 * matrix of the pressure over the viscosity, with the ghost penalty of the pressure. D_e is the block of an
 * extra field, which is factorised: good as long as the field reacts on the flow little.
 *
 * The fixed unknown of prepare() is one of the pressure. It is not left out, but the constant of the pressure
 * is taken out of solutions and residuals such that the solution is the same.
 */
class IterativeFlowSolver : public FlowLinearSolver
{
public:
  /**
   * @param tolerance the Euclidean norm of the residual, by that of the right side
   */
  explicit IterativeFlowSolver(double tolerance = 1e-8, unsigned int largest_number_of_iterations = 500);
  ~IterativeFlowSolver() override;

  void prepare(const SubassembledMatrix &matrix, const BlockNumbering &numbering, Index fixed) override;
  /** @throws NoConvergence on all ranks where a solution does not converge */
  void solve(const std::vector<Vector> &right_sides, std::vector<Vector> &solutions) override;

  Report report() const override;
  /** How many iterations the last solve() took, by right side. */
  const std::vector<unsigned int> &iterations() const { return counts; }

private:
  class Preconditioner;
  class Operator;
  class ConstantProjection;
  struct LocalRange;

  const double tolerance;
  const unsigned int largest_number_of_iterations;
  std::unique_ptr<const FlowStructure> structure;
  const SubassembledMatrix *matrix = nullptr;
  std::unique_ptr<ConstantProjection> constant;
  std::unique_ptr<Preconditioner> preconditioner;
  std::vector<unsigned int> counts;
  double basis_memory = 0.; ///< of the last solve() on this rank, in bytes
};
} // namespace Gemmule
