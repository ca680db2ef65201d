// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/model/bending_model.h>

#include <algorithm>

namespace Gemmule
{
double BendingModel::largest_rigidity() const
{
  return std::max(parameters.rigidity_0, parameters.rigidity_1);
}

BendingDensity BendingModel::evaluate(const double curvature, const double composition) const
{
  // weight of phase 1, and its derivatives
  const double c = std::clamp(composition, 0., 1.);
  double s = c, s_c = 1., s_cc = 0.;
  if (parameters.interpolation == Parameters::Interpolation::smooth_step)
  {
    s = c * c * (3. - 2. * c);
    s_c = 6. * c * (1. - c);
    s_cc = 6. - 12. * c;
  }
  if (c != composition)
    s_c = s_cc = 0.;

  const double rigidity_jump = parameters.rigidity_1 - parameters.rigidity_0;
  const double curvature_jump = parameters.spontaneous_curvature_1 - parameters.spontaneous_curvature_0;
  BendingDensity local;
  local.rigidity = parameters.rigidity_0 + s * rigidity_jump;
  local.spontaneous_curvature = parameters.spontaneous_curvature_0 + s * curvature_jump;
  const double d = curvature - local.spontaneous_curvature;
  local.moment = local.rigidity * d;
  local.energy = 0.5 * local.moment * d;
  const double by_weight = 0.5 * rigidity_jump * d * d - local.moment * curvature_jump;
  const double by_weight_twice = (local.rigidity * curvature_jump - 2. * rigidity_jump * d) * curvature_jump;
  local.by_composition = by_weight * s_c;
  local.by_composition_twice = by_weight_twice * s_c * s_c + by_weight * s_cc;
  return local;
}
} // namespace Gemmule
