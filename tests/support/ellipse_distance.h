// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/function.h>

#include <cmath>

namespace Gemmule::Testing
{
/** Signed distance to the ellipse with the given centre and semi-axes along x and y (a circle where they
 * agree). */
class EllipseDistance : public dealii::Function<2>
{
public:
  EllipseDistance(const dealii::Point<2> &centre, const double a, const double b) : centre(centre), a(a), b(b)
  {
  }

  double value(const dealii::Point<2> &p, const unsigned int = 0) const override
  {
    const double x = std::abs(p[0] - centre[0]), y = std::abs(p[1] - centre[1]);
    if (std::abs(a - b) < 1e-15)
      return std::hypot(x, y) - a;
    // The closest point (a cos t, b sin t) of the first quadrant: Newton's method on the derivative of the
    // squared distance, kept inside a bracket.
    double low = 0., high = std::acos(0.), t = std::atan2(a * y, b * x);
    for (unsigned int i = 0; i < 60; ++i)
    {
      const double c = std::cos(t), s = std::sin(t);
      const double slope = (a * a - b * b) * c * s - a * x * s + b * y * c; // decreasing through the minimum
      (slope > 0. ? low : high) = t;
      const double derivative = (a * a - b * b) * (c * c - s * s) - a * x * c - b * y * s;
      double next = t - slope / derivative;
      if (!(next >= low && next <= high))
        next = 0.5 * (low + high);
      if (std::abs(next - t) < 1e-15)
        break;
      t = next;
    }
    const double distance = std::hypot(x - a * std::cos(t), y - b * std::sin(t));
    return x * x / (a * a) + y * y / (b * b) < 1. ? -distance : distance;
  }

private:
  dealii::Point<2> centre;
  double a, b;
};
} // namespace Gemmule::Testing
