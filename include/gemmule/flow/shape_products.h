// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/grid_rule.h>
#include <gemmule/flow/stokes_layout.h>

#include <array>

namespace Gemmule
{
/**
 * Integrals of products of two scalar shapes or their derivatives, by a GridRule. The sums over the grid are
 * taken one direction after the other.
 */
template <int dim>
class ShapeProducts
{
public:
  using Weights = typename GridRule<dim>::Weights;
  static constexpr unsigned int nv = StokesLayout<dim>::n_velocity_nodes;
  static constexpr unsigned int np = StokesLayout<dim>::n_pressure_nodes;
  using VelocityMatrix = std::array<std::array<double, nv>, nv>;
  using MixedMatrix = std::array<std::array<double, np>, nv>;

  /** In the place of a direction: the shape itself instead of its derivative. */
  static constexpr unsigned int no_derivative = dim;

  /** int d_a phi_i d_b phi_j in unit coordinates; exactly symmetric if @p a and @p b are the same. */
  static void velocity(const Weights &weights, unsigned int a, unsigned int b, VelocityMatrix &matrix);

  /** int d_a phi_i psi_j. */
  static void mixed(const Weights &weights, unsigned int a, MixedMatrix &matrix);
};
} // namespace Gemmule
