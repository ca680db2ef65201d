// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace Gemmule
{
/** What the membrane has to keep (dimensionless). */
struct ReferenceMeasures
{
  double area = 0.;      ///< enclosed, at the start of the run; volume in 3D
  double arclength = 0.; ///< of the constraint; area of the membrane in 3D
};
} // namespace Gemmule
