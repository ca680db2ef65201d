// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <Epetra_CrsMatrix.h>
#include <Epetra_MultiVector.h>
#include <Epetra_Vector.h>

namespace Gemmule
{
/**
 * Chebyshev iteration with the diagonal of a symmetric positive definite matrix, for all columns of a
 * Epetra_MultiVector at once: a smoother, or an approximate solver of well-conditioned systems. It takes the
 * eigenvalues of D^-1 A in [l / ratio, l], l a little above the estimate of the largest one by the power
 * method. The error is multiplied by T(t(D^-1 A)) / T(t(0)), T the Chebyshev polynomial of the degree and t
 * the linear map of the interval on [-1, 1] (Saad, Iterative Methods for Sparse Linear Systems, 2003,
 * section 12.3).
 */
class Chebyshev
{
public:
  /** @param matrix must stay as long as this is used. Collective. */
  Chebyshev(const Epetra_CrsMatrix &matrix, unsigned int degree, double ratio);

  /**
   * Improves @p x by as many steps as the degree says.
   * @param residual of x on entry; on exit that of the new x, or of no meaning if @p update_residual is
   * false, which saves a product with the matrix. Collective.
   */
  void smooth(Epetra_MultiVector &residual, Epetra_MultiVector &x, bool update_residual) const;

  /** The upper end of the interval. */
  double upper_end() const { return largest; }

private:
  double estimate_largest_eigenvalue() const;

  const Epetra_CrsMatrix &matrix;
  const unsigned int degree;
  const double ratio;
  Epetra_Vector inverse_diagonal;
  double largest;
};
} // namespace Gemmule
