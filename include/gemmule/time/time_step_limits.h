// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace Gemmule
{
/** Limits of the time step in one state of the membrane (dimensionless times). */
struct TimeStepLimits
{
  double capillary = 0.;    ///< smallest h Ca / |sigma|: the explicit coupling may take some of these
  double displacement = 0.; ///< smallest h / |u.n|: the membrane has moved by a cell

  /** The longest step with the given capillary Courant number that keeps the membrane in the narrow band of
   * its level set. */
  double longest_step(double capillary_courant_number) const;
};
} // namespace Gemmule
