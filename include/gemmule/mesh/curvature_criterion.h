// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/mesh/refinement_criterion.h>

namespace Gemmule
{
/** Cells of the size h resolve the curvature kappa: h |kappa| <= "Curvature tolerance". */
template <int dim>
class CurvatureCriterion : public MembraneRefinement<dim>
{
public:
  explicit CurvatureCriterion(const RefinementContext<dim> &context)
      : box(context.box), tolerance(context.parameters.curvature_tolerance)
  {
  }

  unsigned int level(const MembraneSample<dim> &sample, const double margin) const override
  {
    const double curvature = margin * std::abs(sample.curvature);
    return curvature * box.coarse_size <= tolerance ? 0 : box.level_for(tolerance / curvature);
  }

private:
  BoxLattice<dim> box;
  double tolerance;
};
} // namespace Gemmule
