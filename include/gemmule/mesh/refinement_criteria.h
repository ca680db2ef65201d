// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/mesh/refinement_criterion.h>

#include <memory>
#include <vector>

namespace Gemmule
{
/** The criteria that the parameters switch on, for points of the membrane. */
template <int dim>
std::vector<std::unique_ptr<MembraneRefinement<dim>>>
make_membrane_criteria(const RefinementContext<dim> &context);

/** The criteria that the parameters switch on, for cells. */
template <int dim>
std::vector<std::unique_ptr<CellRefinement<dim>>> make_cell_criteria(const RefinementContext<dim> &context);
} // namespace Gemmule
