// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/chebyshev.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace Gemmule
{
namespace
{
  /** Numbers in [-1, 1] without order, and the same in each run. */
  double scrambled(const long long index)
  {
    std::uint64_t bits = static_cast<std::uint64_t>(index) + 0x9e3779b97f4a7c15u;
    bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9u;
    bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebu;
    return 2. * static_cast<double>((bits ^ (bits >> 31)) >> 11) / 9007199254740992. - 1.;
  }
} // namespace

Chebyshev::Chebyshev(const Epetra_CrsMatrix &matrix, const unsigned int degree, const double ratio)
    : matrix(matrix), degree(degree), ratio(ratio), inverse_diagonal(matrix.RowMap())
{
  matrix.ExtractDiagonalCopy(inverse_diagonal);
  inverse_diagonal.Reciprocal(inverse_diagonal);
  // The power method comes from below, and not all the way in a few steps.
  const double safety = 1.15;
  largest = safety * estimate_largest_eigenvalue();
}

double Chebyshev::estimate_largest_eigenvalue() const
{
  constexpr unsigned int n_steps = 12;
  Epetra_Vector x(matrix.RowMap()), y(matrix.RowMap());
  for (int i = 0; i < x.MyLength(); ++i)
    x[i] = scrambled(matrix.RowMap().GID64(i));
  double eigenvalue = 1.;
  for (unsigned int step = 0; step < n_steps; ++step)
  {
    double norm = 0.;
    x.Norm2(&norm);
    if (norm == 0.)
      break;
    x.Scale(1. / norm);
    matrix.Multiply(false, x, y);
    x.Multiply(1., inverse_diagonal, y, 0.);
    x.Norm2(&eigenvalue);
  }
  return eigenvalue;
}

void Chebyshev::smooth(Epetra_MultiVector &residual, Epetra_MultiVector &x, const bool update_residual) const
{
  const double center = 0.5 * largest * (1. + 1. / ratio), radius = 0.5 * largest * (1. - 1. / ratio);
  const double sigma = center / radius;
  double rho = 1. / sigma;
  Epetra_MultiVector step(x.Map(), x.NumVectors(), false), product(x.Map(), x.NumVectors(), false);
  step.Multiply(1. / center, inverse_diagonal, residual, 0.);
  for (unsigned int k = 0;; ++k)
  {
    x.Update(1., step, 1.);
    const bool last = k + 1 == degree;
    if (last && !update_residual)
      break;
    matrix.Multiply(false, step, product);
    residual.Update(-1., product, 1.);
    if (last)
      break;
    const double next_rho = 1. / (2. * sigma - rho);
    step.Multiply(2. * next_rho / radius, inverse_diagonal, residual, next_rho * rho);
    rho = next_rho;
  }
}
} // namespace Gemmule
