// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/stokes_layout.h>

#include <deal.II/lac/full_matrix.h>

#include <array>

namespace Gemmule
{
/**
 * Integrals over (a part of) one cell from which the element matrix of the Stokes operator
 * int 2 eta D(u):D(v) - p div v - q div u follows for any viscosity and cell size.
 *
 * Only products of scalar shape functions are accumulated point by point: the vector-valued matrix is a
 * rearrangement of them.
 */
template <int dim>
class BulkIntegrals
{
public:
  using Layout = StokesLayout<dim>;

  void clear();

  /** Adds one quadrature point in unit coordinates. */
  void add(const dealii::Point<dim> &point, double weight);

  /**
   * matrix += element matrix in the block of Layout::n rows and columns that starts at @p offset.
   * @param velocity_scale viscosity times the factor that the two gradients in unit coordinates still lack:
   * h^-2 if the weights were physical, h^(dim-2) if they were those of the unit cell
   * @param pressure_scale the same for one gradient: h^-1 or h^(dim-1)
   */
  void add_to(dealii::FullMatrix<double> &matrix, unsigned int offset, double velocity_scale,
              double pressure_scale) const;

private:
  static constexpr unsigned int nv = Layout::n_velocity_nodes;
  static constexpr unsigned int np = Layout::n_pressure_nodes;
  static constexpr unsigned int ng = dim * nv;

  /** int d_a phi_i d_b phi_j, row a nv + i, column b nv + j; upper triangle. */
  std::array<std::array<double, ng>, ng> gradients;
  /** int d_a phi_i psi_j. */
  std::array<std::array<double, np>, ng> divergences;
};
} // namespace Gemmule
