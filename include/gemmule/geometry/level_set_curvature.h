// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/tensor_lagrange.h>

namespace Gemmule
{
/**
 * Sum of the principal curvatures of the level set through a point,
 * div n = (tr H - n . H n) / |grad phi|, n = grad phi / |grad phi|, H the Hessian of phi;
 * positive where the inside (phi < 0) is convex.
 *
 * @param phi derivatives in unit coordinates of a cell; phi may be scaled by any positive factor
 * @param cell_size edge length of the cell
 * @return in units of 1 / @p cell_size, dimensionless for the dimensionless lengths of the program
 */
template <int dim>
double level_set_curvature(const PolynomialValue<dim> &phi, const double cell_size)
{
  const double norm = phi.gradient.norm();
  const dealii::Tensor<1, dim> n = phi.gradient / norm;
  return (trace(phi.hessian) - n * (phi.hessian * n)) / (norm * cell_size);
}
} // namespace Gemmule
