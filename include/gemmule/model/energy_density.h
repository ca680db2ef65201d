// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace Gemmule
{
/** An energy density h(f, fbar) with its derivatives up to second order (dimensionless). */
struct EnergyDerivatives
{
  double value = 0.;
  double f = 0.;         ///< dh/df
  double fbar = 0.;      ///< dh/dfbar
  double ff = 0.;        ///< d2h/df2
  double f_fbar = 0.;    ///< d2h/(df dfbar)
  double fbar_fbar = 0.; ///< d2h/dfbar2
};

/**
 * The derivatives of a density that depends on the composition c = f / fbar alone, by the chain rule.
 *
 * Such a density satisfies f h_f + fbar h_fbar = 0.
 *
 * @param h, h1, h2 value, first and second derivative with respect to c
 */
EnergyDerivatives density_of_composition(double composition, double fbar, double h, double h1, double h2);

/** Double-well potential g(f, fbar) whose minima are the two phases (doc/model.md, "Membrane"). */
class DoubleWell
{
public:
  virtual ~DoubleWell() = default;
  virtual EnergyDerivatives evaluate(double f, double fbar) const = 0;
};

/** Surface energy density gamma(f, fbar) (doc/model.md, "Membrane"). */
class SurfaceEnergy
{
public:
  virtual ~SurfaceEnergy() = default;
  virtual EnergyDerivatives evaluate(double f, double fbar) const = 0;
};
} // namespace Gemmule
