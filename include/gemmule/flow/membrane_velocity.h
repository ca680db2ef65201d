// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/tensor_lagrange.h>

#include <array>

namespace Gemmule
{
/**
 * The velocity <u> = w2 u1 + w1 u2 of the membrane on one cut cell as a Q2 polynomial: what moves the
 * membrane (doc/method-flow.md).
 */
template <int dim>
struct MembraneVelocity
{
  using Basis = TensorLagrange<dim, 2>;

  std::array<dealii::Tensor<1, dim>, Basis::n> nodal; ///< lexicographic
  double cell_size;

  dealii::Tensor<1, dim> value(const dealii::Point<dim> &unit_point) const
  {
    return Basis::value(nodal, unit_point);
  }

  /** Gradient in physical coordinates, [c][d] = d_d u_c. */
  dealii::Tensor<2, dim> gradient(const dealii::Point<dim> &unit_point) const
  {
    typename Basis::Values values;
    typename Basis::Gradients gradients;
    Basis::evaluate(unit_point, values, gradients);
    dealii::Tensor<2, dim> result;
    for (unsigned int i = 0; i < Basis::n; ++i)
      result += outer_product(nodal[i], gradients[i]);
    return result / cell_size;
  }
};
} // namespace Gemmule
