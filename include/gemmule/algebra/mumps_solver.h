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
 * part of the solutions. The symbolic factorisation is kept as long as the pattern is.
 */
class MumpsSolver : public LinearSolver
{
public:
  /** By which the unknowns are ordered before they are eliminated (doc/performance.md). */
  enum class Ordering
  {
    approximate_minimum_degree, ///< the fastest for the matrices of 2D
    pord                        ///< needs less time and memory in 3D
  };

  /** @param symmetric general symmetric (LDL^T), for matrices of which one triangle is stored */
  MumpsSolver(MPI_Comm communicator, bool symmetric,
              Ordering ordering = Ordering::approximate_minimum_degree);
  ~MumpsSolver() override;
  MumpsSolver(const MumpsSolver &) = delete;
  MumpsSolver &operator=(const MumpsSolver &) = delete;

  /** Factorises. @throws SimulationError when the matrix is singular, or when there will not be enough
   * memory: that is known before it is asked for */
  void prepare(const SubassembledMatrix &matrix, const BlockNumbering &numbering, Index fixed) override;

  void solve(const std::vector<Vector> &right_sides, std::vector<Vector> &solutions) override;
  Report report() const override;

private:
  void analyse(const SubassembledMatrix &matrix, unsigned long long n);
  void check_memory() const;
  /** The entries, with those of the fixed unknown isolated from the others. */
  void copy_values(const SubassembledMatrix &matrix, Index fixed);
  void factorise();

  struct Instance;
  std::unique_ptr<Instance> instance;
};
} // namespace Gemmule
