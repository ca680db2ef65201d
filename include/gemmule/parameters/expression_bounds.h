// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/parameters/expression_tree.h>
#include <gemmule/parameters/function_bounds.h>

#include <deal.II/base/point.h>

#include <memory>

namespace Gemmule
{
/**
 * Bounds of an expression of x, y(, z) on cubes by interval arithmetic (Moore, Kearfott and Cloud, 2009):
 * certain up to round-off, and wider than the true range by an amount that vanishes with the size of the
 * cube.
 */
template <int dim>
class ExpressionBounds
{
public:
  explicit ExpressionBounds(const Parameters::ExpressionNode &expression);
  ~ExpressionBounds();

  /** On the cube with that lower corner and edge. */
  FunctionBounds<dim> on_cube(const dealii::Point<dim> &corner, double size) const;

private:
  class Evaluation;
  std::unique_ptr<const Evaluation> evaluation;
};
} // namespace Gemmule
