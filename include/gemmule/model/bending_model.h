// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/parameters/membrane.h>

namespace Gemmule
{
/**
 * Helfrich bending energy per length of membrane
 *
 *   w(kappa, c) = (k(c) / 2) (kappa - kappa_0(c))^2
 *
 * with curvature kappa = div n (positive on a circle) and composition c = f / fbar (doc/model.md,
 * "Bending"; Helfrich 1973). Rigidity k and spontaneous curvature kappa_0 are interpolated between the
 * phases, constant beyond them. Where tension is negative a numerical rigidity can join them. Everything is
 * dimensionless.
 */
class BendingModel
{
public:
  explicit BendingModel(const Parameters::Bending &parameters) : parameters(parameters) {}

  bool is_active() const { return parameters.is_active() || grid_scale > 0.; }

  /** The larger rigidity of the two phases, or that of the grid scale. */
  double largest_rigidity() const;

  /**
   * Sets the rigidity k_h = C |sigma| h^2 that holds a membrane under negative tension sigma together on
   * cells of edge h; 0 if tension is not negative. Where a phase has less, a numerical rigidity with the
   * energy (k_h - k) kappa^2 / 2 makes up for it. The waves that grow fastest then have the length 2 pi
   * sqrt(3 C) h, instead of the shortest there is. C: "Membrane/Bending/Grid-scale rigidity". Source:
   * doc/model.md, "Negative tension".
   */
  void resist_negative_tension(double smallest_tension, double cell_size);

  /** k_h (dimensionless). */
  double grid_scale_rigidity() const { return grid_scale; }
  void set_grid_scale_rigidity(const double rigidity) { grid_scale = rigidity; }

  struct Local
  {
    double rigidity;              ///< k, or k_h if that is more
    double numerical_rigidity;    ///< the part of it that the phase does not have
    double spontaneous_curvature; ///< kappa_0
    double energy;                ///< w, with the part of the numerical rigidity
    double numerical_energy;      ///< that part
    double moment;                ///< w_kappa = k (kappa - kappa_0)
    double by_composition;        ///< w_c = k'/2 (kappa - kappa_0)^2 - k (kappa - kappa_0) kappa_0'
    double by_composition_twice;  ///< w_cc
  };
  Local evaluate(double curvature, double composition) const;

private:
  Parameters::Bending parameters;
  double grid_scale = 0.;
};
} // namespace Gemmule
