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
  add_membrane_velocity(cell.size, matrix);
  add_membrane_pressure(matrix);
}

template <int dim>
void CutCellMatrix<dim>::integrate_membrane(const CutCell<dim> &cell)
{
  GridRule<dim> plain;
  std::array<GridRule<dim>, dim> with_normal;
  typename GridRule<dim>::Weights grid_weights;
  for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
  {
    GridRule<dim>::evaluate(cell.surface_points[q], grid_weights);
    plain.add(grid_weights, cell.surface_weights[q]);
    for (unsigned int d = 0; d < dim; ++d)
      with_normal[d].add(grid_weights, cell.surface_weights[q] * cell.normals[q][d]);
  }

  constexpr unsigned int none = Products::no_derivative;
  Products::velocity(plain.weights(), none, none, mass);
  for (unsigned int d = 0; d < dim; ++d)
  {
    Products::mixed(with_normal[d].weights(), none, pressure[d]);
    for (unsigned int c = 0; c < dim; ++c)
      Products::velocity(with_normal[d].weights(), none, c, traction[c][d]);
  }
  VelocityMatrix normal_derivative = traction[0][0];
  for (unsigned int c = 1; c < dim; ++c)
    for (unsigned int i = 0; i < nv; ++i)
      for (unsigned int j = 0; j < nv; ++j)
        normal_derivative[i][j] += traction[c][c][i][j];
  for (unsigned int c = 0; c < dim; ++c)
    for (unsigned int i = 0; i < nv; ++i)
      for (unsigned int j = 0; j < nv; ++j)
        traction[c][c][i][j] += normal_derivative[i][j];
}

namespace
{
  constexpr std::array<double, 2> sign{{-1., 1.}}; // [v] = v2 - v1
}

template <int dim>
void CutCellMatrix<dim>::add_membrane_velocity(const double h, FullMatrix<double> &matrix) const
{
  // The average of the viscous traction of one function times the jump of the other, both ways round.
  const double stress_scale = 0.5 * fluids.interface_viscosity / h;
  const double penalty = nitsche_penalty * fluids.interface_viscosity / h;

  std::array<double, nv> forward, backward, jump;
  for (unsigned int c = 0; c < dim; ++c)
    for (unsigned int d = 0; d < dim; ++d)
      for (unsigned int i = 0; i < nv; ++i)
      {
        for (unsigned int j = 0; j < nv; ++j)
        {
          forward[j] = stress_scale * traction[c][d][i][j];
          backward[j] = stress_scale * traction[d][c][j][i];
          jump[j] = c == d ? penalty * mass[i][j] : 0.;
        }
        for (unsigned int f = 0; f < 2; ++f)
          for (unsigned int g = 0; g < 2; ++g)
          {
            double *const row =
                &matrix(f * Layout::n + Layout::velocity(c, i), g * Layout::n + Layout::velocity(d, 0));
            for (unsigned int j = 0; j < nv; ++j)
              row[j] += sign[f] * forward[j] + sign[g] * backward[j] + sign[f] * sign[g] * jump[j];
          }
      }
}

template <int dim>
void CutCellMatrix<dim>::add_membrane_pressure(FullMatrix<double> &matrix) const
{
  for (unsigned int c = 0; c < dim; ++c)
    for (unsigned int i = 0; i < nv; ++i)
      for (unsigned int j = 0; j < np; ++j)
        for (unsigned int f = 0; f < 2; ++f)
          for (unsigned int g = 0; g < 2; ++g)
          {
            const double value = -sign[f] * fluids.stress_weight[g] * pressure[c][i][j];
            const unsigned int row = f * Layout::n + Layout::velocity(c, i);
            const unsigned int column = g * Layout::n + Layout::pressure(j);
            matrix(row, column) += value;
            matrix(column, row) += value;
          }
}

template class CutCellMatrix<2>;
template class CutCellMatrix<3>;
} // namespace Gemmule
