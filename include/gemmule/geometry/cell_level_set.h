// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/tensor_lagrange.h>

#include <deal.II/base/function.h>

namespace Gemmule
{
/** The level set of one cell as a function on the unit cell, for deal.II's quadrature generator. */
template <int dim>
class CellLevelSet : public dealii::Function<dim>
{
public:
  using Basis = TensorLagrange<dim, 3>;
  typename Basis::Values nodal;

  double value(const dealii::Point<dim> &p, const unsigned int = 0) const override
  {
    typename Basis::Values v;
    Basis::evaluate(p, v);
    double sum = 0.;
    for (unsigned int i = 0; i < Basis::n; ++i)
      sum += v[i] * nodal[i];
    return sum;
  }

  dealii::Tensor<1, dim> gradient(const dealii::Point<dim> &p, const unsigned int = 0) const override
  {
    typename Basis::Values v;
    typename Basis::Gradients g;
    Basis::evaluate(p, v, g);
    dealii::Tensor<1, dim> sum;
    for (unsigned int i = 0; i < Basis::n; ++i)
      sum += nodal[i] * g[i];
    return sum;
  }

  dealii::SymmetricTensor<2, dim> hessian(const dealii::Point<dim> &p, const unsigned int = 0) const override
  {
    typename Basis::Values v;
    typename Basis::Gradients g;
    typename Basis::Hessians h;
    Basis::evaluate(p, v, g, h);
    dealii::Tensor<2, dim> sum;
    for (unsigned int i = 0; i < Basis::n; ++i)
      sum += nodal[i] * h[i];
    return dealii::symmetrize(sum);
  }
};
} // namespace Gemmule
