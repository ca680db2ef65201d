// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/point.h>

#include <array>

namespace Gemmule
{
/**
 * Weights on the 5^dim Gauss-Lobatto points of the unit cell that stand for a quadrature rule with any
 * points: polynomials of degree four in each coordinate have the same integral. These are the products of two
 * shapes of the velocity or of their derivatives, so that their integrals follow from the tensor structure of
 * the grid, whatever the number of points of the rule.
 */
template <int dim>
class GridRule
{
public:
  static constexpr unsigned int n_1d = 5;
  static constexpr unsigned int n = dim == 2 ? n_1d * n_1d : n_1d * n_1d * n_1d;
  /** Lexicographic, the first coordinate fastest. */
  using Weights = std::array<double, n>;

  static constexpr std::array<double, n_1d> nodes()
  {
    return {{0., 0.17267316464601142810, 0.5, 0.82732683535398857190, 1.}};
  }

  /** The weights that stand for one point in unit coordinates with the weight one. */
  static void evaluate(const dealii::Point<dim> &point, Weights &weights);

  void clear() { sum.fill(0.); }
  /** Adds a point of which evaluate() has the weights. */
  void add(const Weights &weights, const double weight)
  {
    for (unsigned int k = 0; k < n; ++k)
      sum[k] += weight * weights[k];
  }

  const Weights &weights() const { return sum; }

private:
  Weights sum{};
};
} // namespace Gemmule
