// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/chebyshev.h>

#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <memory>

namespace Gemmule
{
/**
 * An approximate inverse of a scalar elliptic matrix of high order elements: smoothing before and after a
 * correction in a space of low order, for which one cycle of algebraic multigrid (ML) stands. Applied to all
 * columns of a vector at once. With the prolongation P: x = S(0), then x += P M (P^T (b - A x)), then x =
 * S(x), S being three steps of Chebyshev's method and M two cycles of ML for P^T A P (doc/method-flow.md,
 * "The iterative solver").
 */
class TwoLevelCycle
{
public:
  using Matrix = dealii::TrilinosWrappers::SparseMatrix;

  /**
   * @param matrix, prolongation must stay as long as this is used; the columns of @p prolongation are the
   * functions of low order, as vectors of the matrix. Collective.
   */
  TwoLevelCycle(const Matrix &matrix, const Matrix &prolongation);

  /** @param right_side overwritten @param x the result. Collective. */
  void apply(Epetra_MultiVector &right_side, Epetra_MultiVector &x) const;

  /** Of the algebraic multigrid. */
  unsigned int n_coarse_levels() const;
  /** Of the coarse matrix on this rank, in bytes. */
  double memory_consumption() const { return coarse_matrix.memory_consumption(); }

private:
  const Matrix &matrix;
  const Matrix &prolongation;
  Chebyshev smoother;
  Matrix coarse_matrix;
  dealii::TrilinosWrappers::PreconditionAMG multigrid;
};
} // namespace Gemmule
