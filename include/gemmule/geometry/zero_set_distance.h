// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/function.h>
#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <memory>
#include <vector>

namespace Gemmule
{
/**
 * About the signed distance from the zero set of a function that need not be a distance: negative where the
 * function is, zero where it is zero, with a slope of one there.
 *
 * Only the sign of the function counts, and where it changes, but not its size: every monotone function of a
 * level set has the same distance, be it flat, steep or saturated. Near the zero set x is projected onto it
 * with tangent and curvature at the nearest of the points that are known, which are found from changes of the
 * sign beside that point. Farther away it is the distance of that point.
 */
template <int dim>
class ZeroSetDistance : public dealii::Function<dim>
{
public:
  /** A point of the zero set, and the largest distance over which such points are apart there. */
  struct KnownPoint
  {
    dealii::Point<dim> point;
    double spacing;
  };

  /** @p function must outlive the object; @p known_points at least one of each part of the zero set. */
  ZeroSetDistance(const dealii::Function<dim> &function, const std::vector<KnownPoint> &known_points);
  ~ZeroSetDistance() override;

  double value(const dealii::Point<dim> &x, unsigned int component = 0) const override;

  /**
   * How far the zero set lies from @p x in a direction of length one, at most @p reach forwards or backwards:
   * what corrects a point that is known to lie near it. Zero where the function does not change its sign
   * there.
   */
  double offset(const dealii::Point<dim> &x, const dealii::Tensor<1, dim> &direction, double reach) const;

  bool is_inside(const dealii::Point<dim> &x) const { return function.value(x) < 0.; }

  /** Of the zero set at the nearest known point; infinite where it is no graph. */
  double curvature(const dealii::Point<dim> &x) const;

  /**
   * Thickness of the thinner one of the layers that a point @p x of the zero set separates, along the normal;
   * infinite where both are thicker than @p reach.
   */
  double thinnest_layer(const dealii::Point<dim> &x, double reach) const;

  /**
   * Of the layer between two parts of the zero set that holds @p x, along the normal at the nearest known
   * point; infinite where one of the two is farther away than @p reach.
   */
  double layer_thickness(const dealii::Point<dim> &x, double reach) const;

private:
  class KnownPoints;

  const dealii::Function<dim> &function;
  std::unique_ptr<const KnownPoints> known_points;
};
} // namespace Gemmule
