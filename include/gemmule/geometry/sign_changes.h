// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/function.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <optional>

namespace Gemmule
{
/**
 * Distance from @p x to the first change of sign of @p function in a direction of length one, looked for in
 * steps of @p step up to @p reach; nothing if there is none. A zero counts as positive.
 */
template <int dim>
std::optional<double> first_sign_change(const dealii::Function<dim> &function, const dealii::Point<dim> &x,
                                        const dealii::Tensor<1, dim> &direction, double step, double reach);

/** The same forwards and backwards, the nearer one of both, backwards as a negative number; expected to be
 * far nearer than @p reach. */
template <int dim>
std::optional<double> nearest_sign_change(const dealii::Function<dim> &function, const dealii::Point<dim> &x,
                                          const dealii::Tensor<1, dim> &direction, double reach);

/** Tangent space and curvature of the zero set of a function at one of its points, from the signs around it.
 */
template <int dim>
struct ZeroSetFrame
{
  dealii::Point<dim> point;
  dealii::Tensor<1, dim> normal;                        ///< of length one
  std::array<dealii::Tensor<1, dim>, dim - 1> tangents; ///< orthonormal
  /** Shape operator: a neighbour s lies at point + s tangents - 1/2 (s curvature s) normal. */
  dealii::SymmetricTensor<2, dim - 1> curvature;
};

/** @return nothing where the zero set is no graph over the distance @p radius. */
template <int dim>
std::optional<ZeroSetFrame<dim>> zero_set_frame(const dealii::Function<dim> &function,
                                                const dealii::Point<dim> &point, double radius);
} // namespace Gemmule
