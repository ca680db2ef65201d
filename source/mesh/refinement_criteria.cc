// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/mesh/curvature_criterion.h>
#include <gemmule/mesh/flow_error_criterion.h>
#include <gemmule/mesh/gap_criterion.h>
#include <gemmule/mesh/membrane_criterion.h>
#include <gemmule/mesh/phase_boundary_criterion.h>
#include <gemmule/mesh/refinement_criteria.h>
#include <gemmule/mesh/wall_criterion.h>

namespace Gemmule
{
// Register criteria here: a line each, and what switches them on.

template <int dim>
std::vector<std::unique_ptr<MembraneRefinement<dim>>>
make_membrane_criteria(const RefinementContext<dim> &context)
{
  const Parameters::Mesh &mesh = context.parameters;
  std::vector<std::unique_ptr<MembraneRefinement<dim>>> criteria;
  criteria.push_back(std::make_unique<MembraneCriterion<dim>>(context));
  criteria.push_back(std::make_unique<WallCriterion<dim>>(context));
  criteria.push_back(std::make_unique<PhaseBoundaryCriterion<dim>>(context));
  if (mesh.curvature_tolerance > 0.)
    criteria.push_back(std::make_unique<CurvatureCriterion<dim>>(context));
  if (mesh.cells_per_gap > 0.)
    criteria.push_back(std::make_unique<GapCriterion<dim>>(context));
  return criteria;
}

template <int dim>
std::vector<std::unique_ptr<CellRefinement<dim>>> make_cell_criteria(const RefinementContext<dim> &context)
{
  std::vector<std::unique_ptr<CellRefinement<dim>>> criteria;
  if (context.parameters.flow_error_tolerance > 0.)
    criteria.push_back(std::make_unique<FlowErrorCriterion<dim>>(context));
  return criteria;
}

#define GEMMULE_INSTANTIATE(dim)                                                                             \
  template std::vector<std::unique_ptr<MembraneRefinement<dim>>> make_membrane_criteria(                     \
      const RefinementContext<dim> &);                                                                       \
  template std::vector<std::unique_ptr<CellRefinement<dim>>> make_cell_criteria(                             \
      const RefinementContext<dim> &);
GEMMULE_INSTANTIATE(2)
GEMMULE_INSTANTIATE(3)
#undef GEMMULE_INSTANTIATE
} // namespace Gemmule
