// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/model/bending_law.h>
#include <gemmule/parameters/membrane.h>

namespace Gemmule
{
/**
 * Helfrich bending energy per length of membrane
 *
 *   w(kappa, c) = (k(c) / 2) (kappa - kappa_0(c))^2
 *
 * with curvature kappa = div n (positive on a circle) and composition c = f / fbar (doc/model.md, "Bending";
 * Helfrich 1973). Rigidity k and spontaneous curvature kappa_0 are interpolated between the phases, constant
 * beyond them. Everything is dimensionless.
 */
class BendingModel : public BendingLaw
{
public:
  explicit BendingModel(const Parameters::Bending &parameters) : parameters(parameters) {}

  /** Does one of the phases resist bending? */
  bool is_active() const { return parameters.is_active(); }

  BendingDensity evaluate(double curvature, double composition) const override;

  /** The larger rigidity of the two phases. */
  double largest_rigidity() const override;

private:
  Parameters::Bending parameters;
};
} // namespace Gemmule
