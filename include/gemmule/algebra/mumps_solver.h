// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/linear_solver.h>

#include <memory>
#include <mpi.h>

namespace Gemmule
{
/**
 * Sparse direct solver MUMPS with everything distributed: each rank gives the entries of the matrix that it
 * has (those of several ranks at one place are added) and its own part of the right sides, and gets its own
 * part of the solutions. Approximate minimum degree ordering, which is the fastest for the matrices of 2D
 * (doc/method-flow.md). The symbolic factorisation is kept as long as the pattern is.
 */
class MumpsSolver : public LinearSolver
{
public:
  /** @param symmetric general symmetric (LDL^T), for matrices of which one triangle is stored */
  MumpsSolver(MPI_Comm communicator, bool symmetric);
  ~MumpsSolver() override;
  MumpsSolver(const MumpsSolver &) = delete;
  MumpsSolver &operator=(const MumpsSolver &) = delete;

  /** Factorises. @throws SimulationError when the matrix is singular, or memory is short */
  void prepare(const SubassembledMatrix &matrix, const BlockNumbering &numbering) override;

  void solve(const std::vector<Vector> &right_sides, std::vector<Vector> &solutions) override;

private:
  void analyse(const SubassembledMatrix &matrix, unsigned long long n);
  void factorise(const std::vector<double> &values);

  struct Instance;
  std::unique_ptr<Instance> instance;
};
} // namespace Gemmule
