// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/coupling/grid_scale_rigidity.h>

#include <algorithm>

namespace Gemmule
{
void GridScaleRigidity::resist_negative_tension(const double smallest_tension, const double cell_size)
{
  grid_scale = coefficient * std::max(-smallest_tension, 0.) * cell_size * cell_size;
}

BendingDensity GridScaleRigidity::evaluate(const double curvature, const double composition) const
{
  BendingDensity local = law.evaluate(curvature, composition);
  local.numerical_rigidity = std::max(grid_scale - local.rigidity, 0.);
  local.rigidity += local.numerical_rigidity;
  local.moment += local.numerical_rigidity * curvature;
  local.numerical_energy = 0.5 * local.numerical_rigidity * curvature * curvature;
  local.energy += local.numerical_energy;
  return local;
}

double GridScaleRigidity::largest_rigidity() const
{
  return std::max(law.largest_rigidity(), grid_scale);
}
} // namespace Gemmule
