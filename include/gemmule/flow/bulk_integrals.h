// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/shape_products.h>
#include <gemmule/flow/stokes_layout.h>

#include <deal.II/lac/full_matrix.h>

namespace Gemmule
{
/**
 * Integrals over (a part of) one cell from which the element matrix of the Stokes operator
 * int 2 eta D(u):D(v) - p div v - q div u follows for any viscosity and cell size.
 *
 * Point by point only the weights of a GridRule are accumulated: the integrals of the products of scalar
 * shapes follow from them, and the vector-valued matrix is a rearrangement of these.
 */
template <int dim>
class BulkIntegrals
{
public:
  using Layout = StokesLayout<dim>;

  void clear() { rule.clear(); }

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
  GridRule<dim> rule;
};
} // namespace Gemmule
