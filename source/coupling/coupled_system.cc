// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/coupling/initial_checks.h>
#include <gemmule/coupling/initial_membrane.h>
#include <gemmule/coupling/phase_step.h>
#include <gemmule/mesh/box_mesh.h>

#include <utility>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // Mesh and flow at the start depend on each other when the flow's error is a criterion.
  constexpr unsigned int largest_number_of_initial_meshes = 6;
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
      bending(triangulation, model.bending(), parameters.bending.grid_scale_rigidity, timer_output),
      membrane_flow(triangulation, parameters, model),
      mesh_policy(triangulation, parameters.mesh, parameters.domain, parameters.membrane, timer_output),
      interface_step(interface, triangulation, mesh_policy, history, reference, parameters.arclength,
                     timer_output)
{
  if (parameters.membrane.tension_model == Parameters::TensionModel::phase_field)
    surface = std::make_unique<SurfaceSolver<dim>>(triangulation, model, parameters.surface);
}

template <int dim>
void CoupledSystem<dim>::reinit_mesh()
{
  TimerOutput::Scope scope(timer_output, "mesh: degrees of freedom");
  interface.reinit_mesh();
  reinit_spaces();
}

template <int dim>
void CoupledSystem<dim>::reinit_spaces()
{
  if (surface)
    surface->reinit_mesh();
  bending.reinit_mesh();
  membrane_flow.reinit_mesh();
}

template <int dim>
void CoupledSystem<dim>::initialise()
{
  InitialMembrane<dim> initial(parameters, triangulation, interface, mesh_policy.adaptation());
  initial.find();
  warnings_of_initial_state = initial.warnings();
  initial.make_mesh();
  // The error of the flow is known once there is a flow: it may ask for another mesh.
  for (unsigned int i = 1;; ++i)
  {
    reinit_spaces();
    initial.make_level_set();
    bending.compute_curvature(interface);
    if (surface)
      initial.make_phases(*surface, bending.curvature());
    reference.area = interface.geometry().enclosed_volume();
    reference.arclength = parameters.arclength.reference_arclength > 0.
                              ? parameters.arclength.reference_arclength
                              : interface.geometry().measure();
    solve_flow(0., parameters.time_stepping.initial_step, nullptr);
    mesh_policy.sample_flow(get_flow());
    if (mesh_policy.flow_samples().empty() || i == largest_number_of_initial_meshes ||
        !initial.refine_mesh(mesh_policy.flow_samples()))
      break;
  }

  InitialChecks<dim>(parameters).flow(get_flow().max_velocity());
  begin_history(0.);
}

template <int dim>
void CoupledSystem<dim>::begin_history(const double time)
{
  history.begin(take_snapshot(time, origin, level_on_mesh(), fields_without_past(get_flow())),
                membrane_flow.time_step_limits(interface.geometry()));
  last_computed_time = time;
  resist_negative_tension();
}

template <int dim>
StepErrors CoupledSystem<dim>::try_step(const double dt)
{
  const TimeStep step = history.next_step(dt);
  const double time = history.time() + dt;
  const MembraneProjection<dim> membrane(history.level_n().patches, origin);
  MembraneMotion<dim> motion(membrane, step);
  TrialClouds<dim> clouds(history, triangulation);
  move_interface(motion, clouds);
  bending.compute_curvature(interface);

  std::vector<TransportedFields<dim>> transported;
  {
    TimerOutput::Scope scope(timer_output, "geometry: transported fields");
    transported = transport_fields(motion, interface.geometry().cut_cells());
  }
  CutCellScalar<dim> predicted;
  if (surface)
  {
    TimerOutput::Scope scope(timer_output, "surface: phases");
    predicted = PhaseStep<dim>(*surface, interface, history)
                    .advance(step, clouds, membrane, transported, bending.curvature());
  }

  CutCellVector<dim> old_velocity(transported.size());
  for (unsigned int c = 0; c < transported.size(); ++c)
    old_velocity[c] = transported[c].velocity_1_back;
  solve_flow(time, dt, &old_velocity);
  last_computed_time = time;
  trial = {take_snapshot(time, origin, level_on_mesh(), transported), dt,
           membrane_flow.time_step_limits(interface.geometry())};
  return estimate_step_errors(interface.geometry(), get_flow(), surface.get(), transported, predicted, step,
                              communicator);
}

template <int dim>
void CoupledSystem<dim>::move_interface(MembraneMotion<dim> &motion, TrialClouds<dim> &clouds)
{
  const auto aim = interface_step.aim(motion, clouds);
  if (mesh_policy.adapt(motion))
  {
    reinit_mesh();
    clouds.reinit_mesh();
  }
  interface_step.move(motion, clouds, aim);
}

template <int dim>
void CoupledSystem<dim>::solve_flow(const double time, const double dt,
                                    const CutCellVector<dim> *old_velocity)
{
  bending.compute_moment(surface.get());
  membrane_flow.solve(time, dt, {interface.geometry(), surface.get(), bending.get(), reference.arclength},
                      old_velocity, timer_output);
}

template <int dim>
LevelOnMesh<dim> CoupledSystem<dim>::level_on_mesh() const
{
  return {interface, membrane_flow, surface.get()};
}

template <int dim>
void CoupledSystem<dim>::accept()
{
  mesh_policy.accept();
  history.accept(std::move(trial.level), trial.step, trial.limits);
  resist_negative_tension();
  mesh_policy.sample_flow(get_flow());
}

template <int dim>
void CoupledSystem<dim>::resist_negative_tension()
{
  bending.grid_scale().resist_negative_tension(membrane_flow.smallest_tension(),
                                               mesh_policy.membrane_cell_size());
}

template <int dim>
bool CoupledSystem<dim>::membrane_is_resolved() const
{
  return RepairStep<dim>(history.level_n()).is_resolved();
}

template <int dim>
RepairReport CoupledSystem<dim>::repair_membrane()
{
  const double old_arclength = reference.arclength;
  try
  {
    return begin_from_repaired_membrane();
  }
  catch (...)
  {
    reference.arclength = old_arclength;
    // They may belong to a shape that is to be forgotten.
    interface.forget_far_nodes();
    throw;
  }
}

template <int dim>
RepairReport CoupledSystem<dim>::begin_from_repaired_membrane()
{
  const RepairStep<dim> repair(history.level_n());
  RepairReport report;
  {
    TimerOutput::Scope scope(timer_output, "geometry: repair");
    report = repair.remove_small_features(reference.area, interface);
  }
  interface_step.cut();
  report.arclength_after = interface.geometry().measure();
  bending.compute_curvature(interface);
  if (surface)
    repair.carry_over_concentrations(interface, bending.curvature(), *surface);
  // The length of sheets that have merged cannot come back: the constraint holds for what is left.
  reference.arclength *= report.arclength_after / report.arclength_before;
  solve_flow(history.time(), parameters.time_stepping.initial_step, nullptr);
  mesh_policy.begin_anew();
  begin_history(history.time());
  mesh_policy.sample_flow(get_flow());
  return report;
}

template <int dim>
CoupledState<dim> CoupledSystem<dim>::state() const
{
  CoupledState<dim> state;
  state.levels = history.accepted();
  state.reference = reference;
  state.grid_scale_rigidity = grid_scale_rigidity();
  state.mesh = gather_mesh_cells(triangulation);
  state.mesh_policy = mesh_policy.get_memory();
  state.lowered_levels = mesh_policy.lowered_levels();
  state.membrane_cells = mesh_policy.adaptation().load_balance().membrane_cells();
  state.level_set = interface.level_set().gather_cells();
  state.level_set_is_set_everywhere = interface.level_set().is_set_everywhere();
  return state;
}

template <int dim>
void CoupledSystem<dim>::restore(const CoupledState<dim> &state)
{
  refine_to_cells(triangulation, state.mesh);
  mesh_policy.adaptation().load_balance().divide_by(state.membrane_cells);
  reinit_mesh();
  interface.restore(state.level_set, state.level_set_is_set_everywhere);
  mesh_policy.restore(state.mesh_policy, state.lowered_levels);
  history.restore(state.levels);
  reference = state.reference;
  bending.grid_scale().set(state.grid_scale_rigidity);
  last_computed_time = history.time();
}

template class CoupledSystem<2>;
template class CoupledSystem<3>;
} // namespace Gemmule
