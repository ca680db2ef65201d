// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/function.h>

#include <cmath>

namespace Gemmule::Testing
{
/**
 * Exact Stokes flow inside and outside a sphere with tension 1 + a P_l(x/r) (Ca = 1), at rest far away: on
 * the sphere u = U P_l n + V grad_1 P_l, l = 1 or 2. Inside, u_r = (A s^(l-1) + B s^(l+1)) P_l and u_theta =
 * ((l+1) A s^(l-1) + (l+3) B s^(l+1)) / (l(l+1)) dP_l/dtheta with s = r/R, outside u_r = (C s^-l + D
 * s^-(l+2)) P_l and u_theta = ((2-l) C s^-l - l D s^-(l+2)) / (l(l+1)) dP_l/dtheta (Lamb's solution).
 */
class SphereFlow : public dealii::Function<3>
{
public:
  SphereFlow(const dealii::Point<3> &center, const double radius, const unsigned int mode,
             const double amplitude, const double viscosity_ratio)
      : dealii::Function<3>(3), center(center), radius(radius), l(mode), amplitude(amplitude)
  {
    const double ratio = viscosity_ratio, k = l, L = k * (k + 1.);
    const double Q1 = 2. * (1. + ratio) * k * k - 2. * ratio + 1.,
                 Q2 = 2. * (1. + ratio) * k * (k + 2.) + 3. * ratio;
    const double U = -L * ((1. + ratio) * k - ratio + 2.) / (Q1 * Q2) * amplitude;
    const double V =
        ((1. + ratio) * (2. * k * k * k + 3. * k * k - 2. * k) - 3. * ratio) / (Q1 * Q2) * amplitude;
    B = (L * V - (k + 1.) * U) / 2.;
    A = U - B;
    C = (L * V + k * U) / 2.;
    D = U - C;
  }

  dealii::Tensor<1, 3> velocity(const dealii::Point<3> &p) const
  {
    const dealii::Tensor<1, 3> x = p - center;
    const double r = x.norm(), s = r / radius, c = r > 0. ? x[0] / r : 1., k = l, L = k * (k + 1.);
    double radial, polar; // of P_l, and of dP_l/dtheta
    if (s < 1.)
    {
      radial = A * std::pow(s, k - 1.) + B * std::pow(s, k + 1.);
      polar = ((k + 1.) * A * std::pow(s, k - 1.) + (k + 3.) * B * std::pow(s, k + 1.)) / L;
    }
    else
    {
      radial = C * std::pow(s, -k) + D * std::pow(s, -k - 2.);
      polar = ((2. - k) * C * std::pow(s, -k) - k * D * std::pow(s, -k - 2.)) / L;
    }
    // dP_l/dtheta e_theta = -P_l'(c) sin(theta) e_theta = P_l'(c) (e_x - c e_r)
    const dealii::Tensor<1, 3> e_r = r > 0. ? x / r : dealii::Tensor<1, 3>({1., 0., 0.});
    dealii::Tensor<1, 3> e_x;
    e_x[0] = 1.;
    return radial * legendre(c) * e_r + polar * derivative(c) * (e_x - c * e_r);
  }

  double value(const dealii::Point<3> &p, const unsigned int component) const override
  {
    return velocity(p)[component];
  }

  double tension(const dealii::Point<3> &p) const
  {
    const dealii::Tensor<1, 3> x = p - center;
    return 1. + amplitude * legendre(x[0] / x.norm());
  }

private:
  double legendre(const double c) const { return l == 1 ? c : 1.5 * c * c - 0.5; }
  double derivative(const double c) const { return l == 1 ? 1. : 3. * c; }

  const dealii::Point<3> center;
  const double radius;
  const unsigned int l;
  const double amplitude;
  double A, B, C, D;
};
} // namespace Gemmule::Testing
