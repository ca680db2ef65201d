// SPDX-License-Identifier: LGPL-2.1-or-later
// The mesh of CoupledSystem, and the level set that cuts it.
#include <gemmule/base/exceptions.h>
#include <gemmule/base/gather.h>
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/coupling/wall_cells.h>

#include <algorithm>
#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
void CoupledSystem<dim>::reinit_mesh()
{
  TimerOutput::Scope scope(timer_output, "mesh: degrees of freedom");
  interface.reinit_mesh();
  reinit_spaces();
  steps_since_remeshing = 0;
}

template <int dim>
void CoupledSystem<dim>::reinit_spaces()
{
  if (surface)
    surface->reinit_mesh();
  if (bending)
    bending->reinit_mesh();
  membrane_flow.reinit_mesh();
}

template <int dim>
void CoupledSystem<dim>::check_wall() const
{
  if (count_wall_cells(triangulation, interface.geometry(), communicator).not_outside > 0)
    throw SimulationError("The membrane has reached the wall of the box. Use a larger box, or end earlier.");
}

template <int dim>
void CoupledSystem<dim>::check_refined_cells() const
{
  const double allowed =
      (1. + 1e-10) * parameters.domain.cell_size(adaptation.limited(parameters.mesh.membrane_level));
  double largest = 0.;
  for (const auto &cell : interface.geometry().cut_cells())
    largest = std::max(largest, cell.size);
  if (Utilities::MPI::max(largest, communicator) > allowed)
    throw StepBreakdown("The membrane has left the refined cells around it: the step is too long.");
}

template <int dim>
void CoupledSystem<dim>::sample_flow()
{
  flow_samples.clear();
  if (!adaptation.needs_cell_samples())
    return;
  TimerOutput::Scope scope(timer_output, "flow: error estimate");
  const FlowErrorEstimate estimate = get_flow().estimate_error();
  // A flow at rest has no error that would be worth a finer mesh.
  const double norm = std::max(std::sqrt(estimate.norm_square), 1e-12);
  std::vector<CellSample<dim>> own;
  unsigned int k = 0; // the estimate has the owned cells in the order of the mesh
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      CellSample<dim> sample{};
      for (unsigned int d = 0; d < dim; ++d)
        sample.center[d] = cell->center()[d];
      sample.level = cell->level();
      sample.error = std::sqrt(estimate.squares[k++]) / norm;
      own.push_back(sample);
    }
  flow_samples = gather_plain(own, communicator);
}

template <int dim>
std::vector<MembraneSample<dim>> CoupledSystem<dim>::samples(const MembraneProjection<dim> &membrane,
                                                             const MembraneMotion<dim> *motion) const
{
  using Fields = MembraneFields<dim>;
  std::vector<MembraneSample<dim>> result;
  for (const auto &s : membrane.samples())
  {
    ClosestPoint<dim> p;
    p.point = s.point;
    p.normal = s.normal;
    p.patch = s.patch;
    p.unit_point = s.unit_point;
    p.converged = true;
    MembraneSample<dim> sample;
    sample.point = s.point;
    sample.normal = s.normal;
    sample.curvature = membrane.curvature(s);
    if (surface)
      sample.composition =
          membrane.value(p, &Fields::concentration) / membrane.value(p, &Fields::total_concentration);
    result.push_back(sample);
    if (motion != nullptr)
    {
      sample.point += motion->displacement(p);
      sample.time_level = 1;
      result.push_back(sample);
    }
  }
  return result;
}

template <int dim>
bool CoupledSystem<dim>::adapt_mesh(const MembraneProjection<dim> &membrane,
                                    const MembraneMotion<dim> *motion)
{
  bool changed = false;
  {
    TimerOutput::Scope scope(timer_output, "mesh: adaptation");
    const auto wanted = samples(membrane, motion);
    ++steps_since_remeshing;
    if (steps_since_remeshing >= parameters.mesh.remeshing_interval || adaptation.is_too_coarse(wanted, 1))
    {
      changed = adaptation.adapt(wanted, flow_samples);
      steps_since_remeshing = 0;
    }
  }
  if (changed)
  {
    ++n_mesh_changes;
    n_steps_on_mesh = 0;
    reinit_mesh();
  }
  return changed;
}

template <int dim>
void CoupledSystem<dim>::check_cut_cells() const
{
  check_wall();
  check_refined_cells();
}

template <int dim>
void CoupledSystem<dim>::cut_mesh()
{
  TimerOutput::Scope scope(timer_output, "geometry: cut cells");
  last_area_correction = 0.;
  interface.cut();
  check_cut_cells();
  last_area_correction = interface.shift_to_volume(area_0);
  if (last_area_correction != 0.)
    check_cut_cells();
}

template void CoupledSystem<2>::reinit_mesh();
template void CoupledSystem<3>::reinit_mesh();
template void CoupledSystem<2>::reinit_spaces();
template void CoupledSystem<3>::reinit_spaces();
template void CoupledSystem<2>::sample_flow();
template void CoupledSystem<3>::sample_flow();
template bool CoupledSystem<2>::adapt_mesh(const MembraneProjection<2> &, const MembraneMotion<2> *);
template bool CoupledSystem<3>::adapt_mesh(const MembraneProjection<3> &, const MembraneMotion<3> *);
template void CoupledSystem<2>::cut_mesh();
template void CoupledSystem<3>::cut_mesh();
} // namespace Gemmule
