// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/base/gather.h>
#include <gemmule/coupling/mesh_policy.h>

#include <algorithm>
#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  /** 10-90 % width of the equilibrium profile (1 + tanh(s / (2 sqrt(2) C))) / 2; 0 without phases. */
  double phase_boundary_width(const Parameters::Membrane &membrane)
  {
    return membrane.tension_model == Parameters::TensionModel::phase_field
               ? 4. * std::sqrt(2.) * std::atanh(0.8) * membrane.cahn_number
               : 0.;
  }
} // namespace

template <int dim>
MeshPolicy<dim>::MeshPolicy(Triangulation &triangulation, const Parameters::Mesh &mesh,
                            const Parameters::Domain &domain, const Parameters::Membrane &membrane,
                            TimerOutput &timer)
    : triangulation(triangulation), parameters(mesh), domain(domain),
      has_phases(membrane.tension_model == Parameters::TensionModel::phase_field), timer(timer),
      mesh_adaptation(triangulation, mesh, phase_boundary_width(membrane))
{
}

template <int dim>
std::vector<MembraneSample<dim>> MeshPolicy<dim>::samples(const MembraneMotion<dim> &motion) const
{
  using Fields = MembraneFields<dim>;
  const MembraneProjection<dim> &membrane = motion.old_membrane();
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
    if (has_phases)
      sample.composition =
          membrane.value(p, &Fields::concentration) / membrane.value(p, &Fields::total_concentration);
    result.push_back(sample);
    sample.point += motion.displacement(p);
    sample.time_level = 1;
    result.push_back(sample);
  }
  return result;
}

template <int dim>
bool MeshPolicy<dim>::adapt(const MembraneMotion<dim> &motion)
{
  TimerOutput::Scope scope(timer, "mesh: adaptation");
  const auto wanted = samples(motion);
  ++memory.steps_since_remeshing;
  if (memory.steps_since_remeshing < parameters.remeshing_interval &&
      !mesh_adaptation.is_too_coarse(wanted, 1))
    return false;
  memory.steps_since_remeshing = 0;
  if (!mesh_adaptation.adapt(wanted, memory.flow_samples))
    return false;
  ++n_mesh_changes;
  memory.n_steps_on_mesh = 0;
  return true;
}

template <int dim>
void MeshPolicy<dim>::sample_flow(const StokesSolver<dim> &flow)
{
  memory.flow_samples.clear();
  if (!mesh_adaptation.needs_cell_samples())
    return;
  TimerOutput::Scope scope(timer, "flow: error estimate");
  const FlowErrorEstimate estimate = flow.estimate_error();
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
  memory.flow_samples = gather_plain(own, triangulation.get_communicator());
}

template <int dim>
double MeshPolicy<dim>::membrane_cell_size() const
{
  return domain.cell_size(mesh_adaptation.limited(parameters.membrane_level));
}

template <int dim>
void MeshPolicy<dim>::check_refined(const CutGeometry<dim> &geometry) const
{
  double largest = 0.;
  for (const auto &cell : geometry.cut_cells())
    largest = std::max(largest, cell.size);
  if (Utilities::MPI::max(largest, triangulation.get_communicator()) > (1. + 1e-10) * membrane_cell_size())
    throw StepBreakdown("The membrane has left the refined cells around it: the step is too long.");
}

template <int dim>
void MeshPolicy<dim>::restore(const MeshPolicyMemory<dim> &earlier, const unsigned int lowered_levels)
{
  memory = earlier;
  mesh_adaptation.set_lowered_levels(lowered_levels);
}

template class MeshPolicy<2>;
template class MeshPolicy<3>;
} // namespace Gemmule
