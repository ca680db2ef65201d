// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/block_numbering.h>
#include <gemmule/algebra/subassembled_matrix.h>

#include <deal.II/lac/la_parallel_vector.h>

#include <vector>

namespace Gemmule
{
/** Solves the equations of a LinearSystem: the seam between assembly and the methods of linear algebra. */
class LinearSolver
{
public:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

  virtual ~LinearSolver() = default;

  /**
   * Everything that depends on the matrix only. It is called whenever values have changed; what depends on
   * the pattern alone is kept while SubassembledMatrix::pattern_version() stays. Matrix and numbering must
   * stay unchanged as long as solve() is called. Collective.
   * @throws SimulationError on all ranks when that is impossible
   */
  virtual void prepare(const SubassembledMatrix &matrix, const BlockNumbering &numbering) = 0;

  /**
   * Solves for several right sides at once.
   * @param right_sides complete on their owners (compressed)
   * @param solutions on entry guesses, which an iterative method starts from; on exit the solutions on their
   * owners. Collective.
   * @throws SimulationError on all ranks
   */
  virtual void solve(const std::vector<Vector> &right_sides, std::vector<Vector> &solutions) = 0;
};
} // namespace Gemmule
