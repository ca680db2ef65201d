// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/mesh/refinement_criterion.h>

namespace Gemmule
{
/** The same level everywhere on the membrane ("Membrane level"). */
template <int dim>
class MembraneCriterion : public MembraneRefinement<dim>
{
public:
  explicit MembraneCriterion(const RefinementContext<dim> &context)
      : membrane_level(context.parameters.membrane_level)
  {
  }

  unsigned int level(const MembraneSample<dim> &, double) const override { return membrane_level; }

private:
  unsigned int membrane_level;
};
} // namespace Gemmule
