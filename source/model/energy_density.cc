// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/model/energy_density.h>

namespace Gemmule
{
EnergyDerivatives density_of_composition(const double c, const double fbar, const double h, const double h1,
                                         const double h2)
{
  const double inverse = 1. / fbar;
  EnergyDerivatives e;
  e.value = h;
  e.f = h1 * inverse;
  e.fbar = -c * h1 * inverse;
  e.ff = h2 * inverse * inverse;
  e.f_fbar = -(h1 + c * h2) * inverse * inverse;
  e.fbar_fbar = c * (2. * h1 + c * h2) * inverse * inverse;
  return e;
}
} // namespace Gemmule
