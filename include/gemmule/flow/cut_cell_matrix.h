// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/bulk_integrals.h>
#include <gemmule/geometry/cut_geometry.h>

#include <deal.II/lac/full_matrix.h>

#include <array>

namespace Gemmule
{
/** Viscosities of the two fluids ([0] inside) and the weights of the interface averages
 * (doc/method-flow.md). */
struct FluidPair
{
  /** @param viscosity_ratio inside over outside; the outside viscosity is the unit */
  explicit FluidPair(double viscosity_ratio);

  std::array<double, 2> viscosity;
  /** {T n} = w1 T1 n + w2 T2 n: the other fluid's share of the viscosity, so that w1 eta1 = w2 eta2. */
  std::array<double, 2> stress_weight;
  /** <v> = w2 v1 + w1 v2: the swapped weights. */
  std::array<double, 2> velocity_weight;
  /** eta_Gamma = 2 eta1 eta2 / (eta1 + eta2) = 2 w_i eta_i. */
  double interface_viscosity;
};

/**
 * Element matrix of a cut cell, both fluids one after the other: the Stokes operator on the two parts and
 * Nitsche's terms {T(u,p)n}.[v] + {T(v,q)n}.[u] + (gamma eta_Gamma / h) [u].[v] on the membrane (Hansbo,
 * Larson, Zahedi 2014).
 *
 * Both fluids share the scalar shapes on the membrane, and w1 eta1 = w2 eta2: one set of integrals,
 * distributed with signs, gives all blocks.
 */
template <int dim>
class CutCellMatrix
{
public:
  using Layout = StokesLayout<dim>;
  static constexpr unsigned int n = 2 * Layout::n;

  CutCellMatrix(const FluidPair &fluids, double nitsche_penalty);

  /** @param matrix n times n, overwritten */
  void compute(const CutCell<dim> &cell, dealii::FullMatrix<double> &matrix);

private:
  using Products = ShapeProducts<dim>;
  using VelocityMatrix = typename Products::VelocityMatrix;

  void integrate_membrane(const CutCell<dim> &cell);
  void add_membrane_velocity(double h, dealii::FullMatrix<double> &matrix) const;
  void add_membrane_pressure(dealii::FullMatrix<double> &matrix) const;

  static constexpr unsigned int nv = Layout::n_velocity_nodes;
  static constexpr unsigned int np = Layout::n_pressure_nodes;

  FluidPair fluids;
  double nitsche_penalty;
  BulkIntegrals<dim> bulk;
  // On the membrane, in unit coordinates:
  VelocityMatrix mass; ///< phi_i phi_j
  /** [c][d]: the component c of the viscous traction of phi_j e_d, times phi_i:
   * (delta_cd d_n phi_j + n_d d_c phi_j) phi_i. */
  std::array<std::array<VelocityMatrix, dim>, dim> traction;
  std::array<typename Products::MixedMatrix, dim> pressure; ///< [c]: n_c phi_i psi_j
};
} // namespace Gemmule
