// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/gather.h>
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/coupling/initial_checks.h>
#include <gemmule/coupling/initial_membrane.h>
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/mesh/box_mesh.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // Mesh and flow at the start depend on each other when the flow's error is a criterion.
  constexpr unsigned int largest_number_of_initial_meshes = 6;

  /** 10-90 % width of the equilibrium profile (1 + tanh(s / (2 sqrt(2) C))) / 2; 0 without phases. */
  double phase_boundary_width(const Parameters::Membrane &membrane)
  {
    return membrane.tension_model == Parameters::TensionModel::phase_field
               ? 4. * std::sqrt(2.) * std::atanh(0.8) * membrane.cahn_number
               : 0.;
  }

  /** Q2 nodal values as Q3 nodal values of the same polynomial. */
  template <int dim, typename T>
  std::array<T, TensorLagrange<dim, 3>::n> raise_degree(const std::array<T, TensorLagrange<dim, 2>::n> &u)
  {
    using Table = std::array<typename TensorLagrange<dim, 2>::Values, TensorLagrange<dim, 3>::n>;
    static const Table table = []
    {
      Table t;
      for (unsigned int i = 0; i < t.size(); ++i)
        TensorLagrange<dim, 2>::evaluate(TensorLagrange<dim, 3>::node(i), t[i]);
      return t;
    }();
    std::array<T, TensorLagrange<dim, 3>::n> raised{};
    for (unsigned int i = 0; i < raised.size(); ++i)
      for (unsigned int j = 0; j < u.size(); ++j)
        raised[i] += table[i][j] * u[j];
    return raised;
  }
} // namespace

template <int dim>
CoupledSystem<dim>::CoupledSystem(const AllParameters &parameters_, const MPI_Comm communicator_)
    : parameters(parameters_), communicator(communicator_),
      // Rebuilt after each change, the order of the cells does not depend on the history of the mesh: a
      // resumed run sums in the same order as one that was never interrupted.
      triangulation(communicator, dealii::Triangulation<dim>::MeshSmoothing::none,
                    Triangulation::mesh_reconstruction_after_repartitioning),
      origin(
          [this]
          {
            make_box_mesh(triangulation, parameters.domain, parameters.mesh.bulk_level);
            return parameters.domain.lower<dim>();
          }()),
      // Without the communicator: with it, every exception would be preceded by a banner on the screen.
      timer_output(std::cout, TimerOutput::never, TimerOutput::cpu_and_wall_times),
      model(parameters.membrane, parameters.regularisation, parameters.bending), interface(triangulation),
      membrane_flow(triangulation, parameters, model),
      adaptation(triangulation, parameters.mesh, phase_boundary_width(parameters.membrane))
{
  if (parameters.membrane.tension_model == Parameters::TensionModel::phase_field)
    surface = std::make_unique<SurfaceSolver<dim>>(triangulation, model, parameters.surface);
  if (model.bending().is_active())
    bending = std::make_unique<MembraneBending<dim>>(triangulation, model.bending());
}

template <int dim>
void CoupledSystem<dim>::initialise()
{
  InitialMembrane<dim> initial(parameters, triangulation, interface, adaptation);
  initial.find();
  warnings_of_initial_state = initial.warnings();
  initial.make_mesh();
  // The error of the flow is known once there is a flow: it may ask for another mesh.
  for (unsigned int i = 1;; ++i)
  {
    reinit_spaces();
    initial.make_level_set();
    const MembranePointValues *const curvature = compute_curvature();
    if (surface)
      initial.make_phases(*surface, curvature);
    area_0 = interface.geometry().enclosed_volume();
    arclength_0 = parameters.arclength.reference_arclength > 0. ? parameters.arclength.reference_arclength
                                                                : interface.geometry().measure();
    solve_flow(0., parameters.time_stepping.initial_step, nullptr);
    sample_flow();
    if (flow_samples.empty() || i == largest_number_of_initial_meshes || !initial.refine_mesh(flow_samples))
      break;
  }

  InitialChecks<dim>(parameters).flow(get_flow().max_velocity());
  start_history(0.);
}

template <int dim>
void CoupledSystem<dim>::start_history(const double time)
{
  std::vector<TransportedFields<dim>> at_rest(interface.geometry().cut_cells().size());
  for (unsigned int c = 0; c < at_rest.size(); ++c)
    for (unsigned int i = 0; i < MembraneFields<dim>::n; ++i)
      at_rest[c].velocity_1_back[i] = raise_degree<dim>(get_flow().membrane_velocity()[c].nodal)[i];
  history.begin(take_snapshot(time, at_rest), membrane_flow.time_step_limits(interface.geometry()));
  last_computed_time = time;
  resist_negative_tension();
}

template <int dim>
const MembranePointValues *CoupledSystem<dim>::compute_curvature()
{
  if (!bending)
    return nullptr;
  TimerOutput::Scope scope(timer_output, "surface: curvature");
  bending->compute_curvature(interface);
  return &bending->curvature();
}

template <int dim>
void CoupledSystem<dim>::solve_flow(const double time, const double dt,
                                    const CutCellVector<dim> *old_velocity)
{
  membrane_flow.solve(time, dt, {interface.geometry(), surface.get(), bending.get(), arclength_0},
                      old_velocity, timer_output);
}

template <int dim>
bool CoupledSystem<dim>::has_arclength_multiplier() const
{
  return parameters.arclength.model == Parameters::ArclengthModel::multiplier;
}

template <int dim>
MembraneSnapshot<dim>
CoupledSystem<dim>::take_snapshot(const double time,
                                  const std::vector<TransportedFields<dim>> &transported) const
{
  const auto &cut_cells = interface.geometry().cut_cells();
  std::vector<MembraneFields<dim>> fields(cut_cells.size());
  for (unsigned int c = 0; c < cut_cells.size(); ++c)
  {
    fields[c].velocity = raise_degree<dim>(get_flow().membrane_velocity()[c].nodal);
    fields[c].displacement = transported[c].displacement;
    fields[c].velocity_1_back = transported[c].velocity_1_back;
    if (has_arclength_multiplier())
      fields[c].tension_velocity = raise_degree<dim>(membrane_flow.tension_velocity()[c].nodal);
    if (surface)
    {
      fields[c].concentration = raise_degree<dim>(surface->concentration()[c]);
      fields[c].total_concentration = raise_degree<dim>(surface->total_concentration()[c]);
      fields[c].chemical_potential = raise_degree<dim>(surface->chemical_potential()[c]);
      fields[c].concentration_1_back = transported[c].concentration_1_back;
      fields[c].concentration_2_back = transported[c].concentration_2_back;
    }
  }
  MembraneSnapshot<dim> snapshot;
  snapshot.time = time;
  snapshot.origin = origin;
  snapshot.patches = gather_patches(cut_cells, fields, communicator);
  snapshot.narrow_band = interface.level_set().gather_narrow_band();
  snapshot.cloud = gather_cloud(surface ? surface->cloud() : bare_cloud(interface.geometry()), communicator);
  return snapshot;
}

template <int dim>
void CoupledSystem<dim>::accept()
{
  ++n_steps_on_mesh;
  history.accept(std::move(trial.level), trial.step, trial.limits);
  resist_negative_tension();
  sample_flow();
}

template <int dim>
void CoupledSystem<dim>::resist_negative_tension()
{
  const double cell_size = parameters.domain.cell_size(adaptation.limited(parameters.mesh.membrane_level));
  model.bending().resist_negative_tension(membrane_flow.smallest_tension(), cell_size);
}

template class CoupledSystem<2>;
template class CoupledSystem<3>;
} // namespace Gemmule
