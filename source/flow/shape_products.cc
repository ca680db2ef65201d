// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/shape_products.h>

namespace Gemmule
{
using namespace dealii;

namespace
{
  constexpr unsigned int n_grid_1d = GridRule<2>::n_1d;

  /** Products of two one-dimensional shapes at the nodes of the grid: [node][i * (number of j) + j]. */
  template <unsigned int n_pairs>
  using PairTable = std::array<std::array<double, n_pairs>, n_grid_1d>;

  /** By the order of the derivative of either shape. */
  template <int degree_i, int degree_j>
  struct PairTables
  {
    static constexpr unsigned int n_i = degree_i + 1, n_j = degree_j + 1, n_pairs = n_i * n_j;
    std::array<std::array<PairTable<n_pairs>, 2>, 2> tables;

    PairTables()
    {
      std::array<std::array<double, n_i>, 3> phi;
      std::array<std::array<double, n_j>, 3> psi;
      for (unsigned int node = 0; node < n_grid_1d; ++node)
      {
        TensorLagrange<1, degree_i>::basis_1d(GridRule<2>::nodes()[node], 1, phi);
        TensorLagrange<1, degree_j>::basis_1d(GridRule<2>::nodes()[node], 1, psi);
        for (unsigned int a = 0; a < 2; ++a)
          for (unsigned int b = 0; b < 2; ++b)
            for (unsigned int i = 0; i < n_i; ++i)
              for (unsigned int j = 0; j < n_j; ++j)
                tables[a][b][node][i * n_j + j] = phi[a][i] * psi[b][j];
      }
    }
  };

  template <int degree_i, int degree_j>
  const PairTables<degree_i, degree_j> &pair_tables()
  {
    static const PairTables<degree_i, degree_j> tables;
    return tables;
  }

  /** result[p][m] = sum_k table[k][p] source[k][m]: the slowest direction of the source is contracted. */
  template <unsigned int n_pairs, unsigned int n_rest>
  void contract_first(const double *const source, const PairTable<n_pairs> &table, double *const result)
  {
    for (unsigned int p = 0; p < n_pairs; ++p)
    {
      double *const row = result + p * n_rest;
      for (unsigned int m = 0; m < n_rest; ++m)
        row[m] = table[0][p] * source[m];
      for (unsigned int k = 1; k < n_grid_1d; ++k)
        for (unsigned int m = 0; m < n_rest; ++m)
          row[m] += table[k][p] * source[k * n_rest + m];
    }
  }

  /** result[m][p] = sum_k table[k][p] source[k][m]. */
  template <unsigned int n_pairs, unsigned int n_rest>
  void contract_first_to_last(const double *const source, const PairTable<n_pairs> &table,
                              double *const result)
  {
    for (unsigned int m = 0; m < n_rest; ++m)
    {
      double *const row = result + m * n_pairs;
      for (unsigned int p = 0; p < n_pairs; ++p)
        row[p] = table[0][p] * source[m];
      for (unsigned int k = 1; k < n_grid_1d; ++k)
        for (unsigned int p = 0; p < n_pairs; ++p)
          row[p] += table[k][p] * source[k * n_rest + m];
    }
  }

  /**
   * The sums over the grid for all pairs: [pair in x][pair in y][pair in z]. The last direction comes first,
   * so that the innermost loops of the longer sums run over many pairs.
   */
  template <int dim, unsigned int n_pairs>
  void contract(const typename GridRule<dim>::Weights &weights,
                const std::array<const PairTable<n_pairs> *, dim> &tables, double *const result)
  {
    if constexpr (dim == 2)
    {
      std::array<double, n_grid_1d * n_pairs> lines; // [x][pair in y]
      contract_first_to_last<n_pairs, n_grid_1d>(weights.data(), *tables[1], lines.data());
      contract_first<n_pairs, n_pairs>(lines.data(), *tables[0], result);
    }
    else
    {
      constexpr unsigned int n_plane = n_grid_1d * n_grid_1d;
      std::array<double, n_plane * n_pairs> planes; // [y][x][pair in z]
      contract_first_to_last<n_pairs, n_plane>(weights.data(), *tables[2], planes.data());
      std::array<double, n_grid_1d * n_pairs * n_pairs> lines; // [x][pair in y][pair in z]
      for (unsigned int x = 0; x < n_grid_1d; ++x)
      {
        std::array<double, n_grid_1d * n_pairs> plane; // [y][pair in z]
        for (unsigned int y = 0; y < n_grid_1d; ++y)
          for (unsigned int p = 0; p < n_pairs; ++p)
            plane[y * n_pairs + p] = planes[(y * n_grid_1d + x) * n_pairs + p];
        contract_first<n_pairs, n_pairs>(plane.data(), *tables[1], lines.data() + x * n_pairs * n_pairs);
      }
      contract_first<n_pairs, n_pairs * n_pairs>(lines.data(), *tables[0], result);
    }
  }

  /** int d_a phi_i d_b psi_j for shapes of two degrees. */
  template <int dim, int degree_i, int degree_j, typename Matrix>
  void integrate_products(const typename GridRule<dim>::Weights &weights, const unsigned int a,
                          const unsigned int b, Matrix &matrix)
  {
    constexpr unsigned int n_i = degree_i + 1, n_j = degree_j + 1, n_pairs = n_i * n_j;
    const auto &all = pair_tables<degree_i, degree_j>().tables;
    std::array<const PairTable<n_pairs> *, dim> tables;
    for (unsigned int d = 0; d < dim; ++d)
      tables[d] = &all[a == d][b == d];
    std::array<double, n_pairs * n_pairs *(dim == 3 ? n_pairs : 1)> pairs;
    contract<dim, n_pairs>(weights, tables, pairs.data());

    const double *pair = pairs.data();
    for (unsigned int ix = 0; ix < n_i; ++ix)
      for (unsigned int jx = 0; jx < n_j; ++jx)
        for (unsigned int iy = 0; iy < n_i; ++iy)
          for (unsigned int jy = 0; jy < n_j; ++jy)
            if constexpr (dim == 2)
              matrix[iy * n_i + ix][jy * n_j + jx] = *pair++;
            else
              for (unsigned int iz = 0; iz < n_i; ++iz)
                for (unsigned int jz = 0; jz < n_j; ++jz)
                  matrix[(iz * n_i + iy) * n_i + ix][(jz * n_j + jy) * n_j + jx] = *pair++;
  }
} // namespace

template <int dim>
void ShapeProducts<dim>::velocity(const Weights &weights, const unsigned int a, const unsigned int b,
                                  VelocityMatrix &matrix)
{
  integrate_products<dim, 2, 2>(weights, a, b, matrix);
  if (a == b) // whatever the compiler makes of the sums
    for (unsigned int i = 0; i < nv; ++i)
      for (unsigned int j = 0; j < i; ++j)
        matrix[i][j] = matrix[j][i];
}

template <int dim>
void ShapeProducts<dim>::mixed(const Weights &weights, const unsigned int a, MixedMatrix &matrix)
{
  integrate_products<dim, 2, 1>(weights, a, no_derivative, matrix);
}

template class ShapeProducts<2>;
template class ShapeProducts<3>;
} // namespace Gemmule
