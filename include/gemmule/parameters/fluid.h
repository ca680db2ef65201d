// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace dealii
{
class ParameterHandler;
}

namespace Gemmule::Parameters
{
/** Section "Fluid": the dimensionless numbers of the Stokes problem (doc/model.md, "Flow"). */
struct Fluid
{
  /** Ca: viscous stress over membrane tension; [T n] = (1/Ca)(sigma kappa n - grad_s sigma). */
  double capillary_number = 1.;
  /** eta_1/eta_2, inside over outside; eta_2 = 1. */
  double viscosity_ratio = 1.;

  void add_parameters(dealii::ParameterHandler &prm);
  /** @throws ParameterError unless both are positive */
  void check() const;
};
} // namespace Gemmule::Parameters
