// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/tensor_lagrange.h>
#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/time/bdf.h>

#include <deal.II/base/tensor.h>

#include <array>
#include <vector>

namespace Gemmule
{
template <int dim>
struct MembraneCloud;

/** A scalar trace field: Q2 nodal values (lexicographic) of each locally owned cut cell, in the order of
 * CutGeometry. */
template <int dim>
using TraceField = std::vector<std::array<double, TensorLagrange<dim, 2>::n>>;

/** A field given to the surface equations: Q3 nodal values (lexicographic) of each locally owned cut cell. */
template <int dim>
using CutCellScalar = std::vector<std::array<double, TensorLagrange<dim, 3>::n>>;
template <int dim>
using CutCellVector = std::vector<std::array<dealii::Tensor<1, dim>, TensorLagrange<dim, 3>::n>>;

/**
 * Everything that a step of the surface equations to time t_n is given from outside. The pointers are not
 * owned; all fields belong to the locally owned cut cells of the geometry at t_n.
 */
template <int dim>
struct SurfaceStep
{
  double time_step = 0.; ///< t_n - t_{n-1}
  BdfCoefficients bdf;

  /** Membranes at t_{n-1} and (second order) t_{n-2}, complete on every rank; unused ones are nullptr. */
  std::array<const MembraneCloud<dim> *, 2> clouds{{nullptr, nullptr}};

  const CutCellVector<dim> *velocity = nullptr;                ///< <u> at t_n (extrapolated)
  const CutCellScalar<dim> *predicted_concentration = nullptr; ///< f at t_n, first guess of Newton's method
  const CutCellScalar<dim> *predicted_total_concentration = nullptr; ///< fbar at t_n; update smoothing only

  /** Curvature of the membrane at t_n, for its part of the chemical potential; nullptr without bending. */
  const MembranePointValues *curvature = nullptr;

  /** fbar at t_{n-1}, t_{n-2}, normally extended from the membranes of then; update smoothing only. */
  std::array<const CutCellScalar<dim> *, 2> extended_total_concentration{{nullptr, nullptr}};
};
} // namespace Gemmule
