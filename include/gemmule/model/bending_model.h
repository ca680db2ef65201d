#pragma once

#include <gemmule/parameters/membrane.h>

namespace Gemmule
{
/**
 * Helfrich bending energy per length of membrane
 *
 *   w(kappa, c) = (k(c) / 2) (kappa - kappa_0(c))^2
 *
 * with curvature kappa = div n (positive on a circle) and composition c = f / fbar (design section 6;
 * Helfrich 1973). Rigidity k and spontaneous curvature kappa_0 are interpolated between the phases, constant
 * beyond them. Everything is dimensionless.
 */
class BendingModel
{
public:
  explicit BendingModel(const Parameters::Bending &parameters) : parameters(parameters) {}

  bool is_active() const { return parameters.is_active(); }

  /** The larger rigidity of the two phases. */
  double largest_rigidity() const;

  struct Local
  {
    double rigidity;              ///< k
    double spontaneous_curvature; ///< kappa_0
    double energy;                ///< w
    double moment;                ///< w_kappa = k (kappa - kappa_0)
    double by_composition;        ///< w_c = k'/2 (kappa - kappa_0)^2 - k (kappa - kappa_0) kappa_0'
    double by_composition_twice;  ///< w_cc
  };
  Local evaluate(double curvature, double composition) const;

private:
  Parameters::Bending parameters;
};
} // namespace Gemmule
