// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/model/energy_density.h>

namespace Gemmule
{
/** g = c^2 (1 - c)^2 / 4, c = f / fbar (doc/model.md, "Membrane"). */
class QuarticDoubleWell : public DoubleWell
{
public:
  EnergyDerivatives evaluate(double f, double fbar) const override;
};
} // namespace Gemmule
