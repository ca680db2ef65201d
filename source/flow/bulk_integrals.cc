// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/bulk_integrals.h>

namespace Gemmule
{
using namespace dealii;

template <int dim>
void BulkIntegrals<dim>::clear()
{
  for (auto &row : gradients)
    row.fill(0.);
  for (auto &row : divergences)
    row.fill(0.);
}

template <int dim>
void BulkIntegrals<dim>::add(const Point<dim> &point, const double weight)
{
  typename Layout::VelocityBasis::Values phi;
  typename Layout::VelocityBasis::Gradients grad_phi;
  typename Layout::PressureBasis::Values psi;
  Layout::VelocityBasis::evaluate(point, phi, grad_phi);
  Layout::PressureBasis::evaluate(point, psi);

  std::array<double, ng> g;
  for (unsigned int a = 0; a < dim; ++a)
    for (unsigned int i = 0; i < nv; ++i)
      g[a * nv + i] = grad_phi[i][a];
  for (unsigned int r = 0; r < ng; ++r)
  {
    const double factor = weight * g[r];
    auto &row = gradients[r];
    for (unsigned int c = r; c < ng; ++c)
      row[c] += factor * g[c];
    for (unsigned int j = 0; j < np; ++j)
      divergences[r][j] += factor * psi[j];
  }
}

template <int dim>
void BulkIntegrals<dim>::add_to(FullMatrix<double> &matrix, const unsigned int offset,
                                const double velocity_scale, const double pressure_scale) const
{
  const auto product = [this](const unsigned int r, const unsigned int c)
  { return r <= c ? gradients[r][c] : gradients[c][r]; };

  // 2 D(phi_i e_c) : D(phi_j e_d) = delta_cd grad phi_i . grad phi_j + d_d phi_i d_c phi_j
  for (unsigned int c = 0; c < dim; ++c)
    for (unsigned int d = c; d < dim; ++d)
      for (unsigned int i = 0; i < nv; ++i)
        for (unsigned int j = (c == d ? i : 0); j < nv; ++j)
        {
          double value = product(d * nv + i, c * nv + j);
          if (c == d)
            for (unsigned int a = 0; a < dim; ++a)
              value += product(a * nv + i, a * nv + j);
          value *= velocity_scale;
          const unsigned int row = offset + Layout::velocity(c, i), column = offset + Layout::velocity(d, j);
          matrix(row, column) += value;
          if (row != column)
            matrix(column, row) += value;
        }

  for (unsigned int c = 0; c < dim; ++c)
    for (unsigned int i = 0; i < nv; ++i)
      for (unsigned int j = 0; j < np; ++j)
      {
        const double value = -pressure_scale * divergences[c * nv + i][j];
        matrix(offset + Layout::velocity(c, i), offset + Layout::pressure(j)) += value;
        matrix(offset + Layout::pressure(j), offset + Layout::velocity(c, i)) += value;
      }
}

template class BulkIntegrals<2>;
template class BulkIntegrals<3>;
} // namespace Gemmule
