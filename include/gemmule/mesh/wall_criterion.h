// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/mesh/refinement_criterion.h>

#include <algorithm>

namespace Gemmule
{
/**
 * "Cells per gap" cells fit between the membrane and the wall of the box. Not to be switched off altogether:
 * the flow needs a whole cell of the outer fluid at the wall, where the velocity is prescribed.
 */
template <int dim>
class WallCriterion : public MembraneRefinement<dim>
{
public:
  explicit WallCriterion(const RefinementContext<dim> &context)
      : box(context.box), cells(std::max(context.parameters.cells_per_gap, least_cells))
  {
  }

  unsigned int level(const MembraneSample<dim> &sample, const double margin) const override
  {
    return box.level_for(box.distance_from_walls(sample.point) / (margin * cells));
  }

private:
  /** A sample in the second cell from the wall leaves the first one whole; half a cell for what lies between
   * samples. */
  static constexpr double least_cells = 1.5;
  BoxLattice<dim> box;
  double cells;
};
} // namespace Gemmule
