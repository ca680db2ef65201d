// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/tensor_lagrange.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <vector>

namespace Gemmule
{
/**
 * Fields on one cut cell as Q3 polynomials (nodal values in lexicographic order): what a membrane carries
 * from one time level to the next. Off the membrane they are constant along normals up to the discretisation
 * error. A name that ends in k_back is a field of k time levels before that of the membrane, at the same
 * material points.
 */
template <int dim>
struct MembraneFields
{
  static constexpr unsigned int n = TensorLagrange<dim, 3>::n;
  using Scalar = std::array<double, n>;
  using Vector = std::array<dealii::Tensor<1, dim>, n>;

  Vector velocity{};         ///< velocity <u> that moves the membrane
  Vector displacement{};     ///< x - X, X the position of the same material point one level back
  Vector velocity_1_back{};  ///< <u>
  Vector tension_velocity{}; ///< velocity due to a uniform tension of one; with an arclength multiplier only
  Scalar concentration_1_back{};
  Scalar concentration_2_back{};
  Scalar concentration{};       ///< f
  Scalar total_concentration{}; ///< f-bar
  Scalar chemical_potential{};  ///< mu
};

/** One cut cell of the membrane: geometry and fields. */
template <int dim>
struct MembranePatch
{
  dealii::Point<dim> corner; ///< lower corner of the cell
  double size;               ///< edge length h
  std::array<double, TensorLagrange<dim, 3>::n> level_set;
  MembraneFields<dim> fields;
};

/** The level set on one cell. */
template <int dim>
struct LevelSetCell
{
  dealii::Point<dim> corner;
  double size;
  std::array<double, TensorLagrange<dim, 3>::n> level_set;
};

/**
 * Quadrature points of the membrane at one time level with the densities there: integrals over an earlier
 * membrane are sums over its cloud, exact on any later mesh (doc/method-surface.md).
 */
template <int dim>
struct MembraneCloud
{
  std::vector<dealii::Point<dim>> points;
  std::vector<dealii::Tensor<1, dim>> normals;
  std::vector<double> weights; ///< lengths (areas in 3D)
  std::vector<double> concentration;
  std::vector<double> total_concentration;
};

/**
 * The membrane at one time level, independent of the mesh and complete on every rank: it survives remeshing
 * and repartitioning without any transfer error (doc/method.md). A new member needs a line in
 * coupling/coupled_state.cc, so that checkpoints have it.
 */
template <int dim>
struct MembraneSnapshot
{
  double time = 0.;
  dealii::Point<dim> origin;               ///< lower corner of the box: cells are at origin + integer * size
  std::vector<MembranePatch<dim>> patches; ///< the cut cells
  std::vector<LevelSetCell<dim>> narrow_band; ///< the cells with an accurate level set
  MembraneCloud<dim> cloud;
};
} // namespace Gemmule
