// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/coupling/active_bending.h>
#include <gemmule/coupling/coupled_state.h>
#include <gemmule/coupling/history.h>
#include <gemmule/coupling/interface_step.h>
#include <gemmule/coupling/membrane_flow.h>
#include <gemmule/coupling/mesh_policy.h>
#include <gemmule/coupling/repair_step.h>
#include <gemmule/coupling/step_errors.h>
#include <gemmule/coupling/take_snapshot.h>
#include <gemmule/coupling/trial_clouds.h>
#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/model/membrane_model.h>
#include <gemmule/parameters/all_parameters.h>
#include <gemmule/surface/membrane_bending.h>
#include <gemmule/surface/surface_solver.h>

#include <deal.II/base/timer.h>
#include <deal.II/distributed/tria.h>

#include <memory>

namespace Gemmule
{
/**
 * Membrane, surface phases and flow on the adaptive mesh, and one time step of them (doc/method.md, "One time
 * step"): the membrane moves with the extrapolated velocity, then the concentrations follow on the new
 * membrane, then tension and Stokes flow. The accepted states are snapshots that do not depend on the mesh; a
 * step that is rejected leaves them bitwise as they were.
 *
 * It owns the parts and calls them in the right order: when the mesh is adapted is up to MeshPolicy, the
 * motion to InterfaceStep, the phases to PhaseStep, the flow to MembraneFlow, a repair to RepairStep.
 */
template <int dim>
class CoupledSystem
{
public:
  using Triangulation = dealii::parallel::distributed::Triangulation<dim>;

  CoupledSystem(const AllParameters &parameters, MPI_Comm communicator);

  /**
   * Mesh, membrane, phases and flow at t = 0.
   * Throws UserError when there is no membrane in the box, or it touches the wall.
   */
  void initialise();

  /** What is needed to continue from the current (accepted) state. Collective. */
  CoupledState<dim> state() const;

  /**
   * Instead of initialise(): continues from state() of a run with the same parameters, on any number of
   * ranks. Throws SimulationError when that is impossible. Collective.
   */
  void restore(const CoupledState<dim> &state);

  /**
   * Computes the state at time() + dt; accept() or another try follows.
   * @throws SimulationError when that is impossible, so that a smaller step may help; ParameterError when an
   * expression of t is not finite at that time, or no flow at the walls, so that none will. On all ranks.
   */
  StepErrors try_step(double dt);

  /** Makes the state of the last try the current one. */
  void accept();

  /** Does the mesh resolve the current membrane (geometry/membrane_repair.h)? */
  bool membrane_is_resolved() const;

  /**
   * Removes from the current membrane what is smaller than the cells, topological changes included, and
   * starts anew from there with a step of first order. Enclosed area and masses stay; the reference
   * arclength changes with the arclength.
   * @throws SimulationError when that is impossible: the state is then as it was. Collective.
   */
  RepairReport repair_membrane();

  /** Time of the current (accepted) state. */
  double time() const { return history.time(); }
  /** Time of the last state that was computed, accepted or not: the time of all that the functions below
   * return. */
  double computed_time() const { return last_computed_time; }
  double last_step() const { return history.last_step(); }

  /** Of the current (accepted) state: what a try computed, or left half done, says nothing about the next
   * one. */
  const TimeStepLimits &time_step_limits() const { return history.limits(); }

  // What the last state that was computed is like, for output.
  const AllParameters &get_parameters() const { return parameters; }
  const Triangulation &mesh() const { return triangulation; }
  const LevelSet<dim> &get_level_set() const { return interface.level_set(); }
  const CutGeometry<dim> &get_geometry() const { return interface.geometry(); }
  /** nullptr with a prescribed tension. */
  const SurfaceSolver<dim> *get_surface() const { return surface.get(); }
  /** nullptr as long as the membrane does not resist bending, also not on the grid scale. */
  const MembraneBending<dim> *get_bending() const { return bending.get(); }
  /** Numerical rigidity that negative tension asks for in the next step (dimensionless; 0: none). */
  double grid_scale_rigidity() const { return bending.grid_scale().value(); }
  /** Lets the next flow be that of a run that is resumed here: an iterative solver begins from zero. */
  void forget_last_flow() { membrane_flow.forget_last_flow(); }
  const StokesSolver<dim> &get_flow() const { return membrane_flow.solver(); }
  const MembraneModel &get_model() const { return model; }
  /** Tension and flow, and how they are coupled. */
  const MembraneFlow<dim> &get_membrane_flow() const { return membrane_flow; }
  double reference_arclength() const { return reference.arclength; }
  double area_correction() const { return interface_step.area_correction(); }
  unsigned int lowered_levels() const { return mesh_policy.lowered_levels(); }
  /** How often the mesh has changed since the object was made. */
  unsigned int mesh_changes() const { return mesh_policy.mesh_changes(); }
  /** What initialise() has to say of the expressions. */
  const std::vector<std::string> &initial_warnings() const { return warnings_of_initial_state; }
  /** Has the mesh changed within the time levels that the estimated errors of the last try look at? */
  bool mesh_is_new() const { return mesh_policy.mesh_is_new(); }
  dealii::TimerOutput &timer() { return timer_output; }

private:
  /** After a change of the mesh. */
  void reinit_mesh();
  /** The part of it without the interface. */
  void reinit_spaces();
  /** Moves the interface, on a mesh that is adapted to @p motion; a multiplier changes the motion. */
  void move_interface(MembraneMotion<dim> &motion, TrialClouds<dim> &clouds);
  /** @param old_velocity of the same material points one step ago; nullptr at the start */
  void solve_flow(double time, double dt, const CutCellVector<dim> *old_velocity);
  /** Takes membrane, phases and flow as they are now for the current state, with no past. */
  void begin_history(double time);
  /** repair_membrane(), which in case of a failure leaves a state that it has half changed. */
  RepairReport begin_from_repaired_membrane();
  /** Lets the negative tension of the current state have its grid-scale rigidity in the next step. */
  void resist_negative_tension();
  /** What the mesh has now. */
  LevelOnMesh<dim> level_on_mesh() const;

  const AllParameters parameters;
  const MPI_Comm communicator;
  Triangulation triangulation;
  const dealii::Point<dim> origin; ///< lower corner of the box
  dealii::TimerOutput timer_output;

  const MembraneModel model;
  Interface<dim> interface;
  std::unique_ptr<SurfaceSolver<dim>> surface; ///< nullptr with a prescribed tension
  ActiveBending<dim> bending;
  MembraneFlow<dim> membrane_flow;

  History<dim> history;
  ReferenceMeasures reference;
  MeshPolicy<dim> mesh_policy;
  InterfaceStep<dim> interface_step;

  /** What the last try has computed. */
  struct Trial
  {
    MembraneSnapshot<dim> level;
    double step = 0.;
    TimeStepLimits limits;
  } trial;
  double last_computed_time = 0.;
  std::vector<std::string> warnings_of_initial_state;
};
} // namespace Gemmule
