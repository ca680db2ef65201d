// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/time/bdf.h>

#include <array>

namespace Gemmule
{
/**
 * The step from level n, the last accepted one, to level n+1, and what the steps before it make of it: the
 * one place where the coefficients of a step come from. Dimensionless times.
 */
class TimeStep
{
public:
  /**
   * @param size t_{n+1} - t_n, positive
   * @param size_1_back t_n - t_{n-1}; 0 if level n is the first one
   * @param size_2_back t_{n-1} - t_{n-2}; 0 if there is no level n-2
   */
  explicit TimeStep(double size, double size_1_back = 0., double size_2_back = 0.);

  double size() const { return step; }

  /** How many of the levels n, n-1, n-2 there are. */
  unsigned int n_levels() const { return step_1_back == 0. ? 1 : step_2_back == 0. ? 2 : 3; }

  /** Second order, with the ratio of the steps; first order from the first level. */
  const BdfCoefficients &bdf() const { return coefficients; }

  /**
   * Weights of the values at levels n, n-1 and n-2 in the extrapolation to level n+1: quadratic if there are
   * three levels, otherwise that of bdf(). Zero for levels that do not exist.
   */
  std::array<double, 3> extrapolation() const;

  /**
   * Milne's device: part of the difference between BDF2 and the quadratic extrapolation that is the error of
   * BDF2. With dt, dt1, dt2 the three steps, newest first, their local errors are
   * dt^2 (dt + dt1)^2 / (6 (2 dt + dt1)) and dt (dt + dt1)(dt + dt1 + dt2) / 6 times the third derivative,
   * of opposite signs. Dimensionless; 0 before there are three levels.
   */
  double milne_factor() const;

private:
  double step, step_1_back, step_2_back;
  BdfCoefficients coefficients;
};
} // namespace Gemmule
