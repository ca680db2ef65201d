// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace Gemmule
{
/**
 * Backward differentiation formula of first or second order for variable steps: with t_n = t_{n-1} + dt,
 *
 *   y'(t_n) = (a0 y_n + a1 y_{n-1} + a2 y_{n-2}) / dt + O(dt^order),
 *   y(t_n)  = e1 y_{n-1} + e2 y_{n-2} + O(dt^order).
 *
 * a0 + a1 + a2 = 0 and e1 + e2 = 1. First order has a2 = e2 = 0.
 */
struct BdfCoefficients
{
  double a0 = 1.;
  double a1 = -1.;
  double a2 = 0.;
  double e1 = 1.;
  double e2 = 0.;
  double inverse_a0 = 1.; ///< from the steps, and not from the rounded a0

  /** Backward Euler, for the first step. */
  static BdfCoefficients first_order() { return {}; }

  /** @param step_ratio (t_n - t_{n-1}) / (t_{n-1} - t_{n-2}), positive */
  static BdfCoefficients second_order(const double step_ratio)
  {
    const double r = step_ratio;
    return {(1. + 2. * r) / (1. + r), -(1. + r), r * r / (1. + r), 1. + r, -r, (1. + r) / (1. + 2. * r)};
  }

  unsigned int order() const { return a2 == 0. ? 1 : 2; }
};
} // namespace Gemmule
