// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/cut_cell_matrix.h>

namespace Gemmule
{
using namespace dealii;

FluidPair::FluidPair(const double viscosity_ratio) : viscosity{{viscosity_ratio, 1.}}
{
  const double sum = viscosity[0] + viscosity[1];
  stress_weight = {{viscosity[1] / sum, viscosity[0] / sum}};
  velocity_weight = {{stress_weight[1], stress_weight[0]}};
  interface_viscosity = 2. * viscosity[0] * viscosity[1] / sum;
}

template <int dim>
CutCellMatrix<dim>::CutCellMatrix(const FluidPair &fluids, const double nitsche_penalty)
    : fluids(fluids), nitsche_penalty(nitsche_penalty)
{
}

template <int dim>
void CutCellMatrix<dim>::compute(const CutCell<dim> &cell, FullMatrix<double> &matrix)
{
  AssertDimension(matrix.m(), n);
  AssertDimension(matrix.n(), n);
  matrix = 0.;
  for (unsigned int fluid = 0; fluid < 2; ++fluid)
  {
    bulk.clear();
    for (unsigned int q = 0; q < cell.bulk_points[fluid].size(); ++q)
      bulk.add(cell.bulk_points[fluid][q], cell.bulk_weights[fluid][q]);
    bulk.add_to(matrix, fluid * Layout::n, fluids.viscosity[fluid] / (cell.size * cell.size), 1. / cell.size);
  }
  integrate_membrane(cell);
  add_membrane_terms(cell.size, matrix);
}

template <int dim>
void CutCellMatrix<dim>::integrate_membrane(const CutCell<dim> &cell)
{
  for (auto &row : membrane)
    row.fill(0.);

  typename Layout::VelocityBasis::Values phi;
  typename Layout::VelocityBasis::Gradients grad_phi;
  typename Layout::PressureBasis::Values psi;
  std::array<double, n_columns> columns;
  for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
  {
    Layout::VelocityBasis::evaluate(cell.surface_points[q], phi, grad_phi);
    Layout::PressureBasis::evaluate(cell.surface_points[q], psi);
    const Tensor<1, dim> &normal = cell.normals[q];

    for (unsigned int j = 0; j < nv; ++j)
    {
      columns[column_value(j)] = phi[j];
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int c = 0; c < dim; ++c)
          columns[column_gradient(d, c, j)] = normal[d] * grad_phi[j][c];
    }
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int j = 0; j < np; ++j)
        columns[column_pressure(c, j)] = normal[c] * psi[j];

    for (unsigned int i = 0; i < nv; ++i)
    {
      const double factor = cell.surface_weights[q] * phi[i];
      for (unsigned int k = 0; k < n_columns; ++k)
        membrane[i][k] += factor * columns[k];
    }
  }
}

template <int dim>
void CutCellMatrix<dim>::add_membrane_terms(const double h, FullMatrix<double> &matrix) const
{
  constexpr std::array<double, 2> sign{{-1., 1.}}; // [v] = v2 - v1
  const double stress_scale = 0.5 * fluids.interface_viscosity / h;
  const double penalty = nitsche_penalty * fluids.interface_viscosity / h;

  // Average of the viscous traction of phi_j e_d times phi_i e_c, up to the sign of the jump:
  // (T n)_c = eta (delta_cd d_n phi_j + n_d d_c phi_j)
  const auto traction =
      [&](const unsigned int c, const unsigned int i, const unsigned int d, const unsigned int j)
  {
    double value = membrane[i][column_gradient(d, c, j)];
    if (c == d)
      for (unsigned int a = 0; a < dim; ++a)
        value += membrane[i][column_gradient(a, a, j)];
    return stress_scale * value;
  };

  for (unsigned int c = 0; c < dim; ++c)
    for (unsigned int i = 0; i < nv; ++i)
    {
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int j = 0; j < nv; ++j)
        {
          const double forward = traction(c, i, d, j);
          const double backward = traction(d, j, c, i);
          const double jump = (c == d) ? penalty * membrane[i][column_value(j)] : 0.;
          for (unsigned int f = 0; f < 2; ++f)
            for (unsigned int g = 0; g < 2; ++g)
              matrix(f * Layout::n + Layout::velocity(c, i), g * Layout::n + Layout::velocity(d, j)) +=
                  sign[f] * forward + sign[g] * backward + sign[f] * sign[g] * jump;
        }

      for (unsigned int j = 0; j < np; ++j)
        for (unsigned int f = 0; f < 2; ++f)
          for (unsigned int g = 0; g < 2; ++g)
          {
            const double value = -sign[f] * fluids.stress_weight[g] * membrane[i][column_pressure(c, j)];
            const unsigned int row = f * Layout::n + Layout::velocity(c, i);
            const unsigned int column = g * Layout::n + Layout::pressure(j);
            matrix(row, column) += value;
            matrix(column, row) += value;
          }
    }
}

template class CutCellMatrix<2>;
template class CutCellMatrix<3>;
} // namespace Gemmule
