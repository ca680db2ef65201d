// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/bending_force.h>
#include <gemmule/flow/flow_error_estimator.h>
#include <gemmule/flow/membrane_force.h>
#include <gemmule/flow/semi_implicit_bending.h>
#include <gemmule/flow/semi_implicit_tension.h>
#include <gemmule/flow/stokes_assembler.h>
#include <gemmule/flow/stokes_solution.h>
#include <gemmule/flow/unfitted_stokes_space.h>

namespace Gemmule
{
/**
 * Penalty Lambda (L - L0) on the arclength L, taken implicitly: the tension of the end of a time step of size
 * dt is Lambda (L - L0 + dt dL/dt) with dL/dt = int div_s <u>. With Lambda infinite it is the Lagrange
 * multiplier of dL/dt = -(L - L0)/dt.
 */
struct ArclengthPenalty
{
  double stiffness; ///< Lambda >= 0, may be infinite
  double excess;    ///< L - L0 of the membrane for which the flow is solved
  double time_step; ///< dt; 0 makes the penalty explicit
};

/**
 * Stokes flow of the two fluids, driven by the tension of the membrane and the velocity on the boundary of
 * the box (design sections 1 and 2).
 *
 * Use: reinit_mesh() after each change of the mesh; prepare() for each position of the membrane; then any
 * number of times solve() and the results. All calls are collective.
 */
template <int dim>
class StokesSolver
{
public:
  using Vector = typename StokesSolution<dim>::Vector;

  /** The triangulation must outlive this; its cells are cubes. */
  StokesSolver(const dealii::parallel::distributed::Triangulation<dim> &triangulation,
               const Parameters::Fluid &fluid, const Parameters::Flow &discretisation);

  void reinit_mesh();

  /**
   * Assembles and factorises. @p geometry must stay unchanged as long as solve() and the results are used.
   * @param boundary_velocity u_infinity, dim components, its time set by the caller
   * @param semi_implicit, semi_implicit_bending damping of the fast shape modes, nullptr for none; what they
   * point to must stay as long as solve() is used
   * Throws SimulationError (membrane at the boundary, factorisation) and UserError (u_infinity with net
   * flux).
   */
  void prepare(const CutGeometry<dim> &geometry, const dealii::Function<dim> &boundary_velocity,
               const SemiImplicitTension<dim> *semi_implicit = nullptr,
               SemiImplicitBending<dim> *semi_implicit_bending = nullptr);

  /**
   * @param tension sigma at the quadrature points of the membrane, without the penalty
   * @param penalty adds its tension to sigma; nullptr for none
   * @param bending adds the bending force; nullptr for none
   */
  void solve(const MembranePointValues &tension, const ArclengthPenalty *penalty = nullptr,
             const BendingForce<dim> *bending = nullptr);

  /** <u> on the locally owned cut cells, in the order of CutGeometry::cut_cells(). */
  const std::vector<MembraneVelocity<dim>> &membrane_velocity() const { return velocity; }

  /** dL/dt = int div_s <u>. */
  double arclength_rate() const { return rate; }
  /** Lambda (L - L0 + dt dL/dt) of the last solve(), which the given tension does not contain. */
  double constraint_tension() const { return penalty_tension; }
  /** The part of membrane_velocity() per unit of the constraint's tension; after a solve() with a penalty. */
  const std::vector<MembraneVelocity<dim>> &tension_velocity() const { return unit_tension_velocity; }
  /** -int sigma_total div_s <u>, less what bending takes up: equals viscous_dissipation() up to
   * discretisation if the boundary is at rest. */
  double membrane_work() const { return work; }
  /** int <u>.n: zero but for the error of the quadrature. */
  double net_flux() const { return flux; }
  /** (Ca/2) int eta |grad u + grad u^T|^2. */
  double viscous_dissipation() const { return bulk.viscous_dissipation(capillary_number); }
  /** Largest speed at the nodes, on the physical side of the membrane. */
  double max_velocity() const { return bulk.max_velocity(); }
  /** Number of unknowns of velocity and pressure (bending has more in the same system). */
  unsigned int n_unknowns() const { return space.n_unknowns(); }
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

private:
  double capillary_number;
  UnfittedStokesSpace<dim> space;
  StokesAssembler<dim> assembler;
  ElementSystem system;
  MembraneForce<dim> force;
  StokesSolution<dim> bulk;
  const CutGeometry<dim> *geometry = nullptr;
  const SemiImplicitTension<dim> *semi_implicit = nullptr;
  const SemiImplicitBending<dim> *semi_implicit_bending = nullptr;

  std::vector<double> rhs; ///< what does not depend on the tension
  std::vector<MembraneVelocity<dim>> velocity, unit_tension_velocity;
  double rate = 0.;
  double penalty_tension = 0.;
  double work = 0.;
  double flux = 0.;
};
} // namespace Gemmule
