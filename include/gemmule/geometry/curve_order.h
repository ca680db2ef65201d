// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <vector>

namespace Gemmule
{
/**
 * Orders points that lie on closed curves in the plane. The successor of a point is the nearest one ahead of
 * it, in the direction that keeps the inside on the left (counter-clockwise for a circle), within a cone of
 * 45 degrees and with a similar normal where there is one. Each curve begins at its leftmost point, the lower
 * one of two that differ by round-off; the curves are in the order of their first points.
 *
 * @param spacing for each point a length comparable to the distance to its neighbours (its quadrature weight)
 * @return one list of indices per curve; each point occurs once
 */
std::vector<std::vector<unsigned int>> order_closed_curves(const std::vector<dealii::Point<2>> &points,
                                                           const std::vector<dealii::Tensor<1, 2>> &normals,
                                                           const std::vector<double> &spacing);
} // namespace Gemmule
