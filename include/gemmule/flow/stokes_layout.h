// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/tensor_lagrange.h>

namespace Gemmule
{
/** The blocks of the flow's unknowns (BlockNumbering); those of extra fields follow. */
enum FlowBlock : unsigned int
{
  velocity_block = 0,
  pressure_block = 1,
  first_extra_block = 2
};

/**
 * Order of the unknowns of one fluid on one cell: the components of the Q2 velocity one after the other, then
 * the Q1 pressure, each in lexicographic order. In this order element matrices fall apart into blocks of
 * scalar shapes.
 */
template <int dim>
struct StokesLayout
{
  using VelocityBasis = TensorLagrange<dim, 2>;
  using PressureBasis = TensorLagrange<dim, 1>;

  static constexpr unsigned int n_velocity_nodes = VelocityBasis::n;
  static constexpr unsigned int n_pressure_nodes = PressureBasis::n;
  static constexpr unsigned int n_velocity = dim * n_velocity_nodes;
  static constexpr unsigned int n = n_velocity + n_pressure_nodes;

  static constexpr unsigned int velocity(unsigned int component, unsigned int node)
  {
    return component * n_velocity_nodes + node;
  }
  static constexpr unsigned int pressure(unsigned int node) { return n_velocity + node; }
};
} // namespace Gemmule
