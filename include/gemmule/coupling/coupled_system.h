// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/coupling/coupled_state.h>
#include <gemmule/coupling/history.h>
#include <gemmule/coupling/membrane_flow.h>
#include <gemmule/coupling/step_errors.h>
#include <gemmule/coupling/trial_clouds.h>
#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_snapshot.h>
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/mesh/mesh_adaptation.h>
#include <gemmule/model/membrane_model.h>
#include <gemmule/parameters/all_parameters.h>
#include <gemmule/surface/membrane_bending.h>
#include <gemmule/surface/surface_solver.h>

#include <deal.II/base/timer.h>
#include <deal.II/distributed/tria.h>

#include <memory>

namespace Gemmule
{
/** What CoupledSystem::repair_membrane() has done. */
struct RepairReport
{
  double radius = 0.; ///< what is thinner than its double is gone
  double arclength_before = 0., arclength_after = 0.;
};

/**
 * Membrane, surface phases and flow on the adaptive mesh, and one time step of them (doc/method.md,
 * "One time step"): the membrane moves with the extrapolated velocity, then the concentrations follow on
 * the new membrane, then tension and Stokes flow. The accepted states are snapshots that do not depend on the
 * mesh; a step that is rejected leaves them bitwise as they were.
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
  const StokesSolver<dim> &get_flow() const { return membrane_flow.solver(); }
  const MembraneModel &get_model() const { return model; }
  /** Tension and flow, and how they are coupled. */
  const MembraneFlow<dim> &get_membrane_flow() const { return membrane_flow; }
  double reference_arclength() const { return arclength_0; }
  double area_correction() const { return last_area_correction; }
  unsigned int lowered_levels() const { return adaptation.lowered_levels(); }
  /** How often the mesh has changed since the object was made. */
  unsigned int mesh_changes() const { return n_mesh_changes; }
  /** What initialise() has to say of the expressions. */
  const std::vector<std::string> &initial_warnings() const { return warnings_of_initial_state; }
  /** Has the mesh changed within the time levels that the estimated errors of the last try look at? */
  bool mesh_is_new() const { return n_steps_on_mesh < 3; }
  dealii::TimerOutput &timer() { return timer_output; }

private:
  /** After a change of the mesh. */
  void reinit_mesh();
  /** The part of it without the interface. */
  void reinit_spaces();
  /** Samples of the current membrane, at its predicted position if there is a motion. */
  std::vector<MembraneSample<dim>> samples(const MembraneProjection<dim> &membrane,
                                           const MembraneMotion<dim> *motion) const;
  /** @return whether the mesh has changed */
  bool adapt_mesh(const MembraneProjection<dim> &membrane, const MembraneMotion<dim> *motion);
  /** Cut cells of the present level set, with the area of the beginning. */
  void cut_mesh();
  /** Throws SimulationError where the membrane may not be. */
  void check_cut_cells() const;

  void check_wall() const;
  /** Curvature for the bending energy at the quadrature points of the cut mesh; nullptr without bending. */
  const MembranePointValues *compute_curvature();
  /** Throws SimulationError if some cut cell is coarser than "Membrane level". */
  void check_refined_cells() const;
  /** Samples the error of the last flow for the criteria that need it. */
  void sample_flow();
  /** @param old_velocity of the same material points one step ago; nullptr at the start */
  void solve_flow(double time, double dt, const CutCellVector<dim> *old_velocity);
  /** Lets the negative tension of the current state have its grid-scale rigidity in the next step. */
  void resist_negative_tension();
  /** Level set and cut mesh of the current membrane after @p motion, with the area of the beginning. */
  void move_level_set(const MembraneMotion<dim> &motion, const TrialClouds<dim> &clouds);
  /** The first part of a step: a mesh for the current membrane and its next place, and its motion there; a
   * multiplier of the arclength changes @p motion. */
  void move_membrane(const MembraneProjection<dim> &membrane, MembraneMotion<dim> &motion,
                     TrialClouds<dim> &clouds);
  /** The second part: the phases on the membrane that has been moved. */
  void advance_phases(const TimeStep &time_step, const TrialClouds<dim> &clouds,
                      const MembraneProjection<dim> &membrane,
                      const std::vector<TransportedFields<dim>> &transported,
                      const CutCellScalar<dim> &predicted, const MembranePointValues *curvature);
  /** Whether there is MembraneBending is a property of the state, not of its history: a resumed run has to
   * find the same. */
  void make_or_drop_bending();
  /** repair_membrane(), which in case of a failure leaves a state that it has half changed. */
  RepairReport begin_from_repaired_membrane();
  /** Takes membrane, phases and flow as they are now for the current state, with no past. */
  void start_history(double time);
  bool has_arclength_multiplier() const;
  /** The arclength that a multiplier gives the membrane in the next step. */
  double next_arclength() const;
  MembraneSnapshot<dim> take_snapshot(double time,
                                      const std::vector<TransportedFields<dim>> &transported) const;

  const AllParameters parameters;
  const MPI_Comm communicator;
  Triangulation triangulation;
  const dealii::Point<dim> origin;
  dealii::TimerOutput timer_output;

  MembraneModel model;
  Interface<dim> interface;
  std::unique_ptr<SurfaceSolver<dim>> surface;
  std::unique_ptr<MembraneBending<dim>> bending; ///< nullptr without bending
  MembraneFlow<dim> membrane_flow;
  MeshAdaptation<dim> adaptation;

  double area_0 = 0., arclength_0 = 0.;
  double last_area_correction = 0.;
  unsigned int steps_since_remeshing = 0;
  unsigned int n_mesh_changes = 0;
  std::vector<std::string> warnings_of_initial_state;
  unsigned int n_steps_on_mesh = 0;          ///< accepted ones since the last change
  std::vector<CellSample<dim>> flow_samples; ///< of the current state; empty if no criterion needs them

  History<dim> history;
  /** What the last try has computed. */
  struct Trial
  {
    MembraneSnapshot<dim> level;
    double step = 0.;
    TimeStepLimits limits;
  } trial;
  double last_computed_time = 0.;
};
} // namespace Gemmule
