// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/extra_field.h>
#include <gemmule/flow/flow_error_estimator.h>
#include <gemmule/flow/flow_guess.h>
#include <gemmule/flow/flow_term.h>
#include <gemmule/flow/interface_velocity.h>
#include <gemmule/flow/stokes_assembler.h>
#include <gemmule/flow/stokes_solution.h>
#include <gemmule/flow/unfitted_stokes_space.h>

#include <memory>

namespace Gemmule
{
struct FlowStructure;

/**
 * Stokes flow of the two fluids, driven by terms on the membrane (FlowTerm) and the velocity on the boundary
 * of the box (doc/method-flow.md).
 *
 * Use: reinit_mesh() after each change of the mesh; prepare() for each position of the membrane; solve(); the
 * results. All calls are collective.
 */
template <int dim>
class StokesSolver
{
public:
  using Vector = typename StokesSolution<dim>::Vector;
  using Terms = std::vector<std::shared_ptr<FlowTerm<dim>>>;

  /**
   * The triangulation must outlive this; its cells are cubes.
   * @param linear_solver nullptr: what @p discretisation says
   */
  StokesSolver(const dealii::parallel::distributed::Triangulation<dim> &triangulation,
               const Parameters::Fluid &fluid, const Parameters::Flow &discretisation,
               std::unique_ptr<LinearSolver> linear_solver = nullptr);
  StokesSolver(const StokesSolver &) = delete; // the linear solver knows this
  StokesSolver &operator=(const StokesSolver &) = delete;

  void reinit_mesh();
  /** Lets an iterative solver begin the next flow from zero, not from the last flow: then the past does not
   * matter. */
  void forget_last_flow() { guess.forget(); }

  /**
   * Assembles the matrix, and hands it to the linear solver. @p geometry must stay unchanged as long as
   * solve() and the results are used.
   * @param boundary_velocity u_infinity, dim components, its time set by the caller
   * @param terms made for the same geometry; at most one of them has a unit force
   * Throws SimulationError (membrane at the boundary, factorisation) and UserError (u_infinity with net
   * flux).
   */
  void prepare(const CutGeometry<dim> &geometry, const dealii::Function<dim> &boundary_velocity,
               const Terms &terms);

  /** Solves for the flow that the terms drive. Throws SimulationError. */
  void solve();

  /** <u> on the locally owned cut cells, in the order of CutGeometry::cut_cells(). */
  const std::vector<MembraneVelocity<dim>> &membrane_velocity() const { return velocity; }

  /** dL/dt = int div_s <u>. */
  double arclength_rate() const { return rate; }
  /** The power of all terms' forces: equals viscous_dissipation() up to discretisation if the boundary is at
   * rest. */
  double membrane_work() const { return work; }
  /** int <u>.n: zero but for the error of the quadrature. */
  double net_flux() const { return flux; }
  /** (Ca/2) int eta |grad u + grad u^T|^2. */
  double viscous_dissipation() const { return bulk.viscous_dissipation(capillary_number); }
  /** Largest speed at the nodes, on the physical side of the membrane. */
  double max_velocity() const { return bulk.max_velocity(); }
  /** Number of unknowns of velocity and pressure (extra fields have more in the same system). */
  dealii::types::global_dof_index n_unknowns() const { return space.n_unknowns(); }
  /** Net flux of the boundary data that was removed. */
  double removed_boundary_flux() const { return space.removed_boundary_flux(); }

  /** Estimated error of the last flow, by cells. Collective. */
  FlowErrorEstimate estimate_error() const
  {
    return FlowErrorEstimator<dim>::estimate(space, *geometry, assembler, bulk);
  }
  /** The locally owned cells (active_cell_index) in the order of estimate_error(). */
  const std::vector<unsigned int> &owned_cells() const { return space.owned_cells(); }

  /** Velocity and pressure (zero mean) for output, see StokesSolution::interpolate(). */
  void interpolate(Vector &values) const { bulk.interpolate(values); }
  /** The Taylor-Hood space of interpolate(): dim velocity components, then the pressure. */
  const dealii::DoFHandler<dim> &dof_handler() const { return space.dof_handler(); }

  /** On the solution of the equations. */
  LinearSolver::Report linear_solver_report() const { return system.solver_report(); }

  /** The equations of the last prepare(), in blocks (FlowBlock), and their solution, ghosted. */
  const LinearSystem &linear_system() const { return system; }
  const LinearSystem::Vector &unknowns() const { return solution; }

private:
  /** @p linear_solver, or what @p discretisation says, with access to find_structure(). */
  std::unique_ptr<LinearSolver> connect(std::unique_ptr<LinearSolver> linear_solver,
                                        const Parameters::Flow &discretisation);
  std::unique_ptr<const FlowStructure> find_structure() const;
  /** Numbers all unknowns, and adds the elements of flow and extra fields. */
  void set_up_system();
  FlowTermContext<dim> context(unsigned int term);
  /** Adds the flow of the unit force, as much of it as its term asks for. */
  void add_unit_force_flow(unsigned int term, const LinearSystem::Vector &unit_force,
                           const LinearSystem::Vector &unit_flow);

  double capillary_number;
  UnfittedStokesSpace<dim> space;
  StokesAssembler<dim> assembler;
  LinearSystem system;
  FlowGuess<dim> guess;
  InterfaceVelocity<dim> interface_velocity;
  StokesSolution<dim> bulk;
  const CutGeometry<dim> *geometry = nullptr;
  Terms terms;
  std::vector<std::unique_ptr<ExtraField<dim>>> extra_fields; ///< by term; nullptr: none

  LinearSystem::Vector wall_right_side; ///< what velocities at the walls contribute
  LinearSystem::Vector solution;
  std::vector<MembraneVelocity<dim>> velocity;
  double rate = 0.;
  double work = 0.;
  double flux = 0.;
};
} // namespace Gemmule
