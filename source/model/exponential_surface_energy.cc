// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/model/exponential_surface_energy.h>

#include <cmath>

namespace Gemmule
{
EnergyDerivatives ExponentialSurfaceEnergy::evaluate(const double f, const double fbar) const
{
  const double c = f / fbar;
  const double gamma = std::exp(-contrast * c);
  return density_of_composition(c, fbar, gamma, -contrast * gamma, contrast * contrast * gamma);
}
} // namespace Gemmule
