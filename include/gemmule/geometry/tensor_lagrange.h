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
   * dealii::FE_Q (Gauss-Lobatto) in lexicographic order: node (i, j, k) has index i + n (j + n k), n = degree + 1.
   *
   * Cells of the mesh are cubes, so that an unfitted method evaluates these at thousands of arbitrary points per
   * step; this does it without virtual calls or allocation. Derivatives are with respect to unit coordinates:
   * divide by the cell size h (gradients) or h^2 (Hessians).
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

  private:
    /** One-dimensional basis and its derivatives up to @p order at @p x, written to b[derivative][node]. */
    static void basis_1d(double x, unsigned int order, std::array<std::array<double, n_1d>, 3> &b)
    {
      constexpr auto t = nodes();
      for (unsigned int i = 0; i < n_1d; ++i)
      {
        // Newton product (value, first, second derivative) grown factor by factor
        double v = 1., d = 0., s = 0.;
        for (unsigned int j = 0; j < n_1d; ++j)
          if (j != i)
          {
            const double scale = 1. / (t[i] - t[j]);
            const double factor = (x - t[j]) * scale;
            if (order > 1)
              s = s * factor + 2. * d * scale;
            d = d * factor + v * scale;
            v *= factor;
          }
        b[0][i] = v;
        b[1][i] = d;
        b[2][i] = s;
      }
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

  /**
   * For component @p component of @p fe (an FE_Q or an FESystem of FE_Q) the cell dof of each node in lexicographic
   * order.
   */
  template <int dim>
  std::vector<unsigned int> lexicographic_cell_dofs(const dealii::FiniteElement<dim> &fe, unsigned int component = 0);

} // namespace Gemmule
