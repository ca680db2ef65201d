// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/flow_guess.h>

#include <algorithm>

namespace Gemmule
{
template <int dim>
void FlowGuess<dim>::remember(const UnfittedStokesSpace<dim> &space,
                              const std::vector<LinearSystem::Vector> &new_flows)
{
  flows.resize(new_flows.size());
  for (unsigned int k = 0; k < flows.size(); ++k)
    for (unsigned int fluid = 0; fluid < 2; ++fluid)
      space.active_dofs(fluid).copy_to_dofs(new_flows[k], flows[k][fluid]);
}

template <int dim>
void FlowGuess<dim>::recall(const UnfittedStokesSpace<dim> &space,
                            std::vector<LinearSystem::Vector> &guesses) const
{
  for (unsigned int k = 0; k < std::min(flows.size(), guesses.size()); ++k)
    for (unsigned int fluid = 0; fluid < 2; ++fluid)
      space.active_dofs(fluid).copy_from_dofs(flows[k][fluid], guesses[k]);
}

template class FlowGuess<2>;
template class FlowGuess<3>;
} // namespace Gemmule
