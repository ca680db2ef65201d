// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/fe/fe.h>

#include <array>
#include <vector>

namespace Gemmule
{
/**
 * Tensor-product Lagrange polynomials of degree 1, 2 or 3 on the unit cell, with the support points of
 * dealii::FE_Q (Gauss-Lobatto) in lexicographic order: node (i, j, k) has index i + n (j + n k), n = degree
 * + 1.
 *
 * Cells of the mesh are cubes, so that an unfitted method evaluates these at thousands of arbitrary points
 * per step; this does it without virtual calls or allocation. Derivatives are with respect to unit
 * coordinates: divide by the cell size h (gradients) or h^2 (Hessians).
 */
template <int dim, int degree>
struct TensorLagrange
{
  static_assert(degree >= 1 && degree <= 3, "support points are known for degrees 1 to 3");

  static constexpr unsigned int n_1d = degree + 1;
  static constexpr unsigned int n = dim == 1 ? n_1d : (dim == 2 ? n_1d * n_1d : n_1d * n_1d * n_1d);

  using Values = std::array<double, n>;
  using Gradients = std::array<dealii::Tensor<1, dim>, n>;
  using Hessians = std::array<dealii::Tensor<2, dim>, n>;

  /** Support points of the one-dimensional basis in [0, 1]. */
  static constexpr std::array<double, n_1d> nodes()
  {
    if constexpr (degree == 1)
      return {{0., 1.}};
    else if constexpr (degree == 2)
      return {{0., 0.5, 1.}};
    else
      return {{0., 0.27639320225002103036, 0.72360679774997896964, 1.}};
  }

  /** Unit coordinates of node @p i in lexicographic order. */
  static dealii::Point<dim> node(unsigned int i)
  {
    constexpr auto x = nodes();
    dealii::Point<dim> p;
    for (unsigned int d = 0; d < dim; ++d, i /= n_1d)
      p[d] = x[i % n_1d];
    return p;
  }

  static void evaluate(const dealii::Point<dim> &p, Values &values);
  static void evaluate(const dealii::Point<dim> &p, Values &values, Gradients &gradients);
  static void evaluate(const dealii::Point<dim> &p, Values &values, Gradients &gradients, Hessians &hessians);

  /** Value of the polynomial with nodal values @p u. T may be a number or a Tensor. */
  template <typename T>
  static T value(const std::array<T, n> &u, const dealii::Point<dim> &p)
  {
    Values v;
    evaluate(p, v);
    T sum{};
    for (unsigned int i = 0; i < n; ++i)
      sum += v[i] * u[i];
    return sum;
  }

  /** One-dimensional basis and its derivatives up to @p order at @p x, written to b[derivative][node]. */
  static void basis_1d(double x, unsigned int order, std::array<std::array<double, n_1d>, 3> &b)
  {
    static const auto coefficients = monomial_coefficients();
    for (unsigned int i = 0; i < n_1d; ++i)
    {
      const auto &c = coefficients[i];
      // Horner's scheme for the value and the derivatives
      double v = c[degree], d = 0., s = 0.;
      for (int k = degree - 1; k >= 0; --k)
      {
        if (order > 1)
          s = s * x + 2. * d;
        if (order > 0)
          d = d * x + v;
        v = v * x + c[k];
      }
      b[0][i] = v;
      b[1][i] = d;
      b[2][i] = s;
    }
  }

private:
  /** Coefficients of the one-dimensional basis: [node][power]. */
  static std::array<std::array<double, n_1d>, n_1d> monomial_coefficients()
  {
    constexpr auto t = nodes();
    std::array<std::array<double, n_1d>, n_1d> coefficients{};
    for (unsigned int i = 0; i < n_1d; ++i)
    {
      auto &c = coefficients[i];
      c[0] = 1.;
      unsigned int current_degree = 0;
      for (unsigned int j = 0; j < n_1d; ++j)
        if (j != i)
        {
          const double scale = 1. / (t[i] - t[j]);
          ++current_degree;
          for (unsigned int k = current_degree; k > 0; --k)
            c[k] = scale * (c[k - 1] - t[j] * c[k]);
          c[0] *= -t[j] * scale;
        }
    }
    return coefficients;
  }

  template <int order>
  static void tensor(const dealii::Point<dim> &p, Values &values, Gradients *gradients, Hessians *hessians)
  {
    std::array<std::array<std::array<double, n_1d>, 3>, dim> b;
    for (unsigned int d = 0; d < dim; ++d)
      basis_1d(p[d], order, b[d]);
    for (unsigned int i = 0; i < n; ++i)
    {
      std::array<unsigned int, dim> k;
      for (unsigned int d = 0, r = i; d < dim; ++d, r /= n_1d)
        k[d] = r % n_1d;
      double v = 1.;
      for (unsigned int d = 0; d < dim; ++d)
        v *= b[d][0][k[d]];
      values[i] = v;
      if constexpr (order > 0)
        for (unsigned int e = 0; e < dim; ++e)
        {
          double g = 1.;
          for (unsigned int d = 0; d < dim; ++d)
            g *= b[d][d == e ? 1 : 0][k[d]];
          (*gradients)[i][e] = g;
        }
      if constexpr (order > 1)
        for (unsigned int e = 0; e < dim; ++e)
          for (unsigned int f = e; f < dim; ++f)
          {
            double h = 1.;
            for (unsigned int d = 0; d < dim; ++d)
              h *= b[d][(d == e ? 1 : 0) + (d == f ? 1 : 0)][k[d]];
            (*hessians)[i][e][f] = (*hessians)[i][f][e] = h;
          }
    }
  }
};

template <int dim, int degree>
void TensorLagrange<dim, degree>::evaluate(const dealii::Point<dim> &p, Values &values)
{
  tensor<0>(p, values, nullptr, nullptr);
}

template <int dim, int degree>
void TensorLagrange<dim, degree>::evaluate(const dealii::Point<dim> &p, Values &values, Gradients &gradients)
{
  tensor<1>(p, values, &gradients, nullptr);
}

template <int dim, int degree>
void TensorLagrange<dim, degree>::evaluate(const dealii::Point<dim> &p, Values &values, Gradients &gradients,
                                           Hessians &hessians)
{
  tensor<2>(p, values, &gradients, &hessians);
}

/** Value and derivatives (with respect to unit coordinates) of one polynomial at one point. */
template <int dim>
struct PolynomialValue
{
  double value = 0.;
  dealii::Tensor<1, dim> gradient;
  dealii::Tensor<2, dim> hessian;
};

/** Evaluates the polynomial with nodal values @p u, derivatives up to @p order, one direction after the
 * other. */
template <int dim, int degree, int order = 0>
PolynomialValue<dim> evaluate_polynomial(const std::array<double, TensorLagrange<dim, degree>::n> &u,
                                         const dealii::Point<dim> &p)
{
  constexpr unsigned int n = degree + 1;
  std::array<std::array<std::array<double, n>, 3>, dim> b;
  for (unsigned int d = 0; d < dim; ++d)
    TensorLagrange<dim, degree>::basis_1d(p[d], order, b[d]);
  PolynomialValue<dim> result;
  // contracted over x for each line, then over y (for each plane, then over z)
  constexpr unsigned int n_planes = dim == 3 ? n : 1;
  constexpr unsigned int n_derivatives = order + 1;
  for (unsigned int k = 0; k < n_planes; ++k)
  {
    double plane[3][3] = {}; // [derivative in x][derivative in y]
    for (unsigned int j = 0; j < n; ++j)
    {
      const double *const line_values = u.data() + (k * n + j) * n;
      for (unsigned int a = 0; a < n_derivatives; ++a)
      {
        double line = 0.;
        for (unsigned int i = 0; i < n; ++i)
          line += b[0][a][i] * line_values[i];
        for (unsigned int c = 0; c + a < n_derivatives; ++c)
          plane[a][c] += b[1][c][j] * line;
      }
    }
    const auto weight = [&](const unsigned int derivative)
    {
      if constexpr (dim == 3)
        return b[2][derivative][k];
      else
        return derivative == 0 ? 1. : 0.;
    };
    result.value += plane[0][0] * weight(0);
    if constexpr (order > 0)
    {
      result.gradient[0] += plane[1][0] * weight(0);
      result.gradient[1] += plane[0][1] * weight(0);
      if constexpr (dim == 3)
        result.gradient[2] += plane[0][0] * weight(1);
    }
    if constexpr (order > 1)
    {
      result.hessian[0][0] += plane[2][0] * weight(0);
      result.hessian[1][1] += plane[0][2] * weight(0);
      result.hessian[0][1] += plane[1][1] * weight(0);
      if constexpr (dim == 3)
      {
        result.hessian[2][2] += plane[0][0] * weight(2);
        result.hessian[0][2] += plane[1][0] * weight(1);
        result.hessian[1][2] += plane[0][1] * weight(1);
      }
    }
  }
  if constexpr (order > 1)
    for (unsigned int d = 0; d < dim; ++d)
      for (unsigned int e = 0; e < d; ++e)
        result.hessian[d][e] = result.hessian[e][d];
  return result;
}

/**
 * For component @p component of @p fe (an FE_Q or an FESystem of FE_Q) the cell dof of each node in
 * lexicographic order.
 */
template <int dim>
std::vector<unsigned int> lexicographic_cell_dofs(const dealii::FiniteElement<dim> &fe,
                                                  unsigned int component = 0);

} // namespace Gemmule
