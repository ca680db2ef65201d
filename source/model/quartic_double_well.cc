// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/model/quartic_double_well.h>

namespace Gemmule
{
EnergyDerivatives QuarticDoubleWell::evaluate(const double f, const double fbar) const
{
  const double c = f / fbar;
  const double b = c * (1. - c);
  return density_of_composition(c, fbar, 0.25 * b * b, 0.5 * b * (1. - 2. * c), 0.5 - 3. * b);
}
} // namespace Gemmule
