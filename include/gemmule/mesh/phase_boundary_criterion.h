// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/mesh/refinement_criterion.h>

#include <algorithm>

namespace Gemmule
{
/**
 * Where the composition lies between the two phases: "Phase boundary level", and as many cells per 10-90 %
 * width of a phase boundary in equilibrium as "Cells per phase boundary" says.
 */
template <int dim>
class PhaseBoundaryCriterion : public MembraneRefinement<dim>
{
public:
  explicit PhaseBoundaryCriterion(const RefinementContext<dim> &context)
      : box(context.box), fixed_level(context.parameters.phase_boundary_level),
        lower(context.parameters.composition_lower), upper(context.parameters.composition_upper),
        largest_size(std::numeric_limits<double>::max())
  {
    if (context.parameters.cells_per_phase_boundary > 0. && context.phase_boundary_width > 0.)
      largest_size = context.phase_boundary_width / context.parameters.cells_per_phase_boundary;
  }

  unsigned int level(const MembraneSample<dim> &sample, const double margin) const override
  {
    // The profile decays exponentially: the margin makes the bounds those parts closer to the pure phases.
    const bool mixed = sample.composition && *sample.composition > lower - (margin - 1.) * std::abs(lower) &&
                       *sample.composition < upper + (margin - 1.) * std::abs(1. - upper);
    // No margin for the cell size: it is no measured quantity and cannot flicker.
    return mixed ? std::max(fixed_level, box.level_for(largest_size)) : 0;
  }

private:
  BoxLattice<dim> box;
  unsigned int fixed_level;
  double lower, upper;
  double largest_size;
};
} // namespace Gemmule
