// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/bulk_integrals.h>

namespace Gemmule
{
using namespace dealii;

template <int dim>
void BulkIntegrals<dim>::add(const Point<dim> &point, const double weight)
{
  typename GridRule<dim>::Weights grid_weights;
  GridRule<dim>::evaluate(point, grid_weights);
  rule.add(grid_weights, weight);
}

template <int dim>
void BulkIntegrals<dim>::add_to(FullMatrix<double> &matrix, const unsigned int offset,
                                const double velocity_scale, const double pressure_scale) const
{
  using Products = ShapeProducts<dim>;
  constexpr unsigned int nv = Layout::n_velocity_nodes, np = Layout::n_pressure_nodes;
  const auto velocity_row = [&](const unsigned int c, const unsigned int i, const unsigned int d)
  { return &matrix(offset + Layout::velocity(c, i), offset + Layout::velocity(d, 0)); };

  // 2 D(phi_i e_c) : D(phi_j e_d) = delta_cd grad phi_i . grad phi_j + d_d phi_i d_c phi_j
  std::array<typename Products::VelocityMatrix, dim> second; // d_c phi_i d_c phi_j
  for (unsigned int c = 0; c < dim; ++c)
    Products::velocity(rule.weights(), c, c, second[c]);
  typename Products::VelocityMatrix laplacian = second[0];
  for (unsigned int c = 1; c < dim; ++c)
    for (unsigned int i = 0; i < nv; ++i)
      for (unsigned int j = 0; j < nv; ++j)
        laplacian[i][j] += second[c][i][j];
  typename Products::VelocityMatrix mixed;
  for (unsigned int c = 0; c < dim; ++c)
  {
    for (unsigned int i = 0; i < nv; ++i)
    {
      double *const row = velocity_row(c, i, c);
      for (unsigned int j = 0; j < nv; ++j)
        row[j] += velocity_scale * (laplacian[i][j] + second[c][i][j]);
    }
    for (unsigned int d = c + 1; d < dim; ++d)
    {
      Products::velocity(rule.weights(), c, d, mixed);
      for (unsigned int i = 0; i < nv; ++i)
      {
        double *const lower = velocity_row(d, i, c), *const upper = velocity_row(c, i, d);
        for (unsigned int j = 0; j < nv; ++j)
        {
          lower[j] += velocity_scale * mixed[i][j];
          upper[j] += velocity_scale * mixed[j][i];
        }
      }
    }
  }

  typename Products::MixedMatrix divergence;
  for (unsigned int c = 0; c < dim; ++c)
  {
    Products::mixed(rule.weights(), c, divergence);
    for (unsigned int i = 0; i < nv; ++i)
      for (unsigned int j = 0; j < np; ++j)
      {
        const double value = -pressure_scale * divergence[i][j];
        matrix(offset + Layout::velocity(c, i), offset + Layout::pressure(j)) += value;
        matrix(offset + Layout::pressure(j), offset + Layout::velocity(c, i)) += value;
      }
  }
}

template class BulkIntegrals<2>;
template class BulkIntegrals<3>;
} // namespace Gemmule
