// SPDX-License-Identifier: LGPL-2.1-or-later
// Saving and restoring what CoupledSystem carries from step to step.
#include <gemmule/coupling/coupled_system.h>

namespace Gemmule
{
template <int dim>
CoupledState<dim> CoupledSystem<dim>::state() const
{
  CoupledState<dim> state;
  state.levels = history.accepted();
  state.area_0 = area_0;
  state.arclength_0 = arclength_0;
  state.grid_scale_rigidity = model.bending().grid_scale_rigidity();
  state.mesh = gather_mesh_cells(triangulation);
  state.steps_since_remeshing = steps_since_remeshing;
  state.lowered_levels = adaptation.lowered_levels();
  state.n_steps_on_mesh = n_steps_on_mesh;
  state.flow_samples = flow_samples;
  state.level_set = interface.level_set().gather_cells();
  state.level_set_is_set_everywhere = interface.level_set().is_set_everywhere();
  return state;
}

template <int dim>
void CoupledSystem<dim>::restore(const CoupledState<dim> &state)
{
  refine_to_cells(triangulation, state.mesh);
  reinit_mesh();
  interface.restore(state.level_set, state.level_set_is_set_everywhere);
  adaptation.set_lowered_levels(state.lowered_levels);
  steps_since_remeshing = state.steps_since_remeshing;
  n_steps_on_mesh = state.n_steps_on_mesh;
  flow_samples = state.flow_samples;
  history.restore(state.levels);
  area_0 = state.area_0;
  arclength_0 = state.arclength_0;
  model.bending().set_grid_scale_rigidity(state.grid_scale_rigidity);
  last_computed_time = history.time();
}

template CoupledState<2> CoupledSystem<2>::state() const;
template CoupledState<3> CoupledSystem<3>::state() const;
template void CoupledSystem<2>::restore(const CoupledState<2> &);
template void CoupledSystem<3>::restore(const CoupledState<3> &);
} // namespace Gemmule
