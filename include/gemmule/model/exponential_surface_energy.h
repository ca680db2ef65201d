// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/model/energy_density.h>

namespace Gemmule
{
/** gamma = exp(-x c), c = f / fbar; x is the contrast between the phases (doc/model.md, "Membrane"). */
class ExponentialSurfaceEnergy : public SurfaceEnergy
{
public:
  explicit ExponentialSurfaceEnergy(double contrast) : contrast(contrast) {}
  EnergyDerivatives evaluate(double f, double fbar) const override;

private:
  double contrast;
};
} // namespace Gemmule
