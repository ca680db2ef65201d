#include <gemmule/mesh/refinement_criteria.h>

namespace Gemmule
{
template <int dim>
MembraneCriterion<dim>::MembraneCriterion(const Parameters::Mesh &parameters)
    : membrane_level(parameters.membrane_level)
{
}

template <int dim>
unsigned int MembraneCriterion<dim>::level(const MembraneSample<dim> &) const
{
  return membrane_level;
}

template <int dim>
PhaseBoundaryCriterion<dim>::PhaseBoundaryCriterion(const Parameters::Mesh &parameters)
    : phase_boundary_level(parameters.phase_boundary_level), lower(parameters.composition_lower),
      upper(parameters.composition_upper)
{
}

template <int dim>
unsigned int PhaseBoundaryCriterion<dim>::level(const MembraneSample<dim> &sample) const
{
  return sample.composition && *sample.composition > lower && *sample.composition < upper
             ? phase_boundary_level
             : 0;
}

template <int dim>
std::vector<std::unique_ptr<RefinementCriterion<dim>>>
make_refinement_criteria(const Parameters::Mesh &parameters)
{
  std::vector<std::unique_ptr<RefinementCriterion<dim>>> criteria;
  criteria.push_back(std::make_unique<MembraneCriterion<dim>>(parameters));
  criteria.push_back(std::make_unique<PhaseBoundaryCriterion<dim>>(parameters));
  return criteria;
}

#define GEMMULE_INSTANTIATE(dim)                                                                             \
  template class MembraneCriterion<dim>;                                                                     \
  template class PhaseBoundaryCriterion<dim>;                                                                \
  template std::vector<std::unique_ptr<RefinementCriterion<dim>>> make_refinement_criteria(                  \
      const Parameters::Mesh &);
GEMMULE_INSTANTIATE(2)
GEMMULE_INSTANTIATE(3)
#undef GEMMULE_INSTANTIATE
} // namespace Gemmule
