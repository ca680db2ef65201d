// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/function.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <array>
#include <cmath>

namespace Gemmule::Testing
{
/**
 * Exact Stokes flow in the plane, inside and outside a circle with tension 1 + a cos(m theta) (Ca = 1), at
 * rest far away. Stream functions psi = sum of C_k r^k sin(m theta), k = m, m + 2 inside and -m, 2 - m
 * outside, u_r = psi_theta / r, u_theta = -psi_r. For m = 1 the outside term of k = 2 - m is a uniform
 * stream, which the decay excludes: the membrane exerts no net force, so that there is no Stokes paradox and
 * one of the jump conditions is redundant.
 */
class CircleFlow : public dealii::Function<2>
{
public:
  CircleFlow(const dealii::Point<2> &center, const double radius, const unsigned int mode,
             const double amplitude, const double viscosity_ratio)
      : dealii::Function<2>(2), center(center), radius(radius), mode(mode), amplitude(amplitude)
  {
    const int m = mode;
    exponents = {{m, m + 2, -m, 2 - m}};
    dealii::FullMatrix<double> conditions(4, 4);
    dealii::Vector<double> jumps(4), solution(4);
    for (unsigned int j = 0; j < 4; ++j)
    {
      const int k = exponents[j];
      const double side = j < 2 ? -1. : 1., viscosity = j < 2 ? viscosity_ratio : 1.;
      const double pressure = k == m + 2 ? 4. * (m + 1) * std::pow(radius, m)
                              : j == 3   ? 4. * (m - 1) * std::pow(radius, -m)
                                         : 0.;
      conditions(0, j) = side * m * std::pow(radius, k - 1);
      conditions(1, j) = -side * k * std::pow(radius, k - 1);
      conditions(2, j) = -side * viscosity * (k * (k - 2) + m * m) * std::pow(radius, k - 2);
      conditions(3, j) = side * viscosity * (2. * m * (k - 1) * std::pow(radius, k - 2) - pressure);
    }
    jumps(2) = amplitude * m / radius;
    jumps(3) = amplitude / radius;
    if (m == 1)
    {
      for (unsigned int j = 0; j < 4; ++j)
        conditions(3, j) = j == 3;
      jumps(3) = 0.;
    }
    conditions.gauss_jordan();
    conditions.vmult(solution, jumps);
    for (unsigned int j = 0; j < 4; ++j)
      coefficients[j] = solution(j);
  }

  dealii::Tensor<1, 2> velocity(const dealii::Point<2> &p) const
  {
    const double x = p[0] - center[0], y = p[1] - center[1], r = std::hypot(x, y), theta = std::atan2(y, x);
    const int m = mode;
    double radial = 0., tangential = 0.;
    for (unsigned int j = (r < radius ? 0 : 2), end = j + 2; j < end; ++j)
    {
      const double power = coefficients[j] * std::pow(r, exponents[j] - 1);
      radial += power * m * std::cos(m * theta);
      tangential -= power * exponents[j] * std::sin(m * theta);
    }
    dealii::Tensor<1, 2> u;
    u[0] = radial * std::cos(theta) - tangential * std::sin(theta);
    u[1] = radial * std::sin(theta) + tangential * std::cos(theta);
    return u;
  }

  double value(const dealii::Point<2> &p, const unsigned int component) const override
  {
    return velocity(p)[component];
  }

  double tension(const dealii::Point<2> &p) const
  {
    return 1. + amplitude * std::cos(mode * std::atan2(p[1] - center[1], p[0] - center[0]));
  }

private:
  dealii::Point<2> center;
  double radius;
  unsigned int mode;
  double amplitude;
  std::array<int, 4> exponents;
  std::array<double, 4> coefficients;
};
} // namespace Gemmule::Testing
