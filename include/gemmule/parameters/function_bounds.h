// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cmath>
#include <limits>

namespace Gemmule
{
/** What is known for certain of a function on a cube: every value lies between the bounds, up to round-off.
 */
template <int dim>
struct FunctionBounds
{
  double lower, upper;                                        ///< infinite if nothing is known
  std::array<double, dim> lower_derivative, upper_derivative; ///< of the partial derivatives
  bool is_defined;                                            ///< false if a value may not be a number

  /** Is there no zero in the cube? */
  bool excludes_zero() const { return is_defined && (lower > 0. || upper < 0.); }

  /** Does a partial derivative keep its sign? The zero set in the cube is a graph then, without closed parts.
   */
  bool is_monotone() const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (lower_derivative[d] > 0. || upper_derivative[d] < 0.)
        return is_defined;
    return false;
  }

  /** Half the diameter of the set of gradients over the length of the middle one: a bound of the sine of the
   * angle by which gradients differ from it. */
  double variation_of_direction() const
  {
    double square_of_width = 0., square_of_middle = 0.;
    for (unsigned int d = 0; d < dim; ++d)
    {
      square_of_width += std::pow(0.5 * (upper_derivative[d] - lower_derivative[d]), 2);
      square_of_middle += std::pow(0.5 * (upper_derivative[d] + lower_derivative[d]), 2);
    }
    return square_of_middle > 0. ? std::sqrt(square_of_width / square_of_middle)
                                 : std::numeric_limits<double>::infinity();
  }
};
} // namespace Gemmule
