// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace Gemmule
{
/** What bending has at one point of the membrane; everything is dimensionless. */
struct BendingDensity
{
  double rigidity = 0.;              ///< k, with the numerical part
  double spontaneous_curvature = 0.; ///< kappa_0
  double energy = 0.;                ///< w per length (area in 3D), with the numerical part
  double moment = 0.;                ///< w_kappa = k (kappa - kappa_0), with the numerical part
  double by_composition = 0.;        ///< w_c = k'/2 (kappa - kappa_0)^2 - k (kappa - kappa_0) kappa_0'
  double by_composition_twice = 0.;  ///< w_cc

  // What discretisation and not physics has added; zero for a constitutive law.
  double numerical_rigidity = 0.;
  double numerical_energy = 0.;
};

/** The bending energy of a membrane as a function of its curvature div n and its composition f / fbar. */
class BendingLaw
{
public:
  virtual ~BendingLaw() = default;

  /** Energy and derivatives at one point. */
  virtual BendingDensity evaluate(double curvature, double composition) const = 0;

  /** Over all compositions (dimensionless). */
  virtual double largest_rigidity() const = 0;
};
} // namespace Gemmule
