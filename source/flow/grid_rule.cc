// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/grid_rule.h>

namespace Gemmule
{
using namespace dealii;

namespace
{
  constexpr unsigned int n_grid = 5;
  using LagrangeValues = std::array<double, n_grid>;

  /** One over the product of the distances of each node to all others. */
  constexpr LagrangeValues inverse_denominators(const LagrangeValues &t)
  {
    LagrangeValues inverse{};
    for (unsigned int k = 0; k < n_grid; ++k)
    {
      double product = 1.;
      for (unsigned int m = 0; m < n_grid; ++m)
        if (m != k)
          product *= t[k] - t[m];
      inverse[k] = 1. / product;
    }
    return inverse;
  }

  /** The Lagrange polynomials of the nodes @p t at @p x. */
  LagrangeValues lagrange_values(const double x, const LagrangeValues &t, const LagrangeValues &inverse)
  {
    LagrangeValues values = inverse;
    double left = 1., right = 1.; // products of the distances to the nodes on either side
    for (unsigned int k = 0; k < n_grid; ++k)
    {
      values[k] *= left;
      left *= x - t[k];
      values[n_grid - 1 - k] *= right;
      right *= x - t[n_grid - 1 - k];
    }
    return values;
  }
} // namespace

template <int dim>
void GridRule<dim>::evaluate(const Point<dim> &point, Weights &weights)
{
  static_assert(n_1d == n_grid);
  constexpr auto t = nodes();
  constexpr auto inverse = inverse_denominators(t);
  std::array<LagrangeValues, dim> l;
  for (unsigned int d = 0; d < dim; ++d)
    l[d] = lagrange_values(point[d], t, inverse);

  std::array<double, n_1d * n_1d> plane;
  for (unsigned int j = 0; j < n_1d; ++j)
    for (unsigned int i = 0; i < n_1d; ++i)
      plane[j * n_1d + i] = l[1][j] * l[0][i];
  if constexpr (dim == 2)
    weights = plane;
  else
    for (unsigned int k = 0; k < n_1d; ++k)
      for (unsigned int m = 0; m < plane.size(); ++m)
        weights[k * plane.size() + m] = l[2][k] * plane[m];
}

template class GridRule<2>;
template class GridRule<3>;
} // namespace Gemmule
