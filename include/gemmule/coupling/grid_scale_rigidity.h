// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/model/bending_law.h>

namespace Gemmule
{
/**
 * The bending law of the membrane on the mesh: that of its phases, and a numerical rigidity that holds it
 * together on cells of edge h where its tension sigma is negative,
 *
 *   k_h = C max(-sigma, 0) h^2,   C: "Membrane/Bending/Grid-scale rigidity".
 *
 * Where a phase has a rigidity k below k_h, the energy (k_h - k) kappa^2 / 2 makes up for it. The waves that
 * grow fastest then have the length 2 pi sqrt(3 C) h, instead of the shortest there is. Source: doc/model.md,
 * "Negative tension". k_h is part of the state of a run; everything is dimensionless.
 */
class GridScaleRigidity : public BendingLaw
{
public:
  /**
   * @param law of the phases; kept by reference
   * @param coefficient C
   */
  GridScaleRigidity(const BendingLaw &law, const double coefficient) : law(law), coefficient(coefficient) {}

  /** Sets k_h; 0 if @p smallest_tension is not negative. @param cell_size h */
  void resist_negative_tension(double smallest_tension, double cell_size);

  /** k_h */
  double value() const { return grid_scale; }
  void set(const double rigidity) { grid_scale = rigidity; }

  BendingDensity evaluate(double curvature, double composition) const override;

  /** The largest of the phases, or k_h. */
  double largest_rigidity() const override;

private:
  const BendingLaw &law;
  const double coefficient;
  double grid_scale = 0.;
};
} // namespace Gemmule
