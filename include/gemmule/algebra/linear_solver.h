// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/block_numbering.h>
#include <gemmule/algebra/subassembled_matrix.h>

#include <deal.II/lac/la_parallel_vector.h>

#include <string>
#include <vector>

namespace Gemmule
{
/** Solves the equations of a LinearSystem: the seam between assembly and the methods of linear algebra. */
class LinearSolver
{
public:
  using Index = BlockNumbering::Index;
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

  virtual ~LinearSolver() = default;

  /**
   * Everything that depends on the matrix only. It is called whenever values have changed; what depends on
   * the pattern alone is kept while SubassembledMatrix::pattern_version() stays. Matrix and numbering must
   * stay unchanged as long as solve() is called. Collective.
   * @param fixed the number of an unknown that is zero, and whose equation is left out: one for which the
   * constant of its block stands that the matrix does not determine. invalid_dof_index: none
   * @throws SimulationError on all ranks when that is impossible
   */
  virtual void prepare(const SubassembledMatrix &matrix, const BlockNumbering &numbering, Index fixed) = 0;

  /**
   * Solves for several right sides at once.
   * @param right_sides complete on their owners (compressed)
   * @param solutions on entry guesses, which an iterative method starts from; on exit the solutions on their
   * owners. Collective.
   * @throws SimulationError on all ranks
   */
  virtual void solve(const std::vector<Vector> &right_sides, std::vector<Vector> &solutions) = 0;

  /** What there is to say about the last prepare() and solve(). */
  struct Report
  {
    std::string method;          ///< for the log
    unsigned int iterations = 0; ///< for all right sides together; 0: a direct solver
    double memory = 0.;          ///< of factors, or of preconditioner and basis, on this rank; in bytes
    std::string warning;         ///< empty: none
  };
  virtual Report report() const = 0;
};
} // namespace Gemmule
