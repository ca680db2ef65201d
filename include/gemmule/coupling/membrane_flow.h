// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/arclength_constraint.h>
#include <gemmule/flow/stokes_solver.h>
#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/model/membrane_model.h>
#include <gemmule/parameters/all_parameters.h>
#include <gemmule/surface/membrane_bending.h>
#include <gemmule/surface/surface_solver.h>
#include <gemmule/time/time_step_limits.h>

#include <deal.II/base/function.h>
#include <deal.II/base/timer.h>
#include <deal.II/distributed/tria.h>

#include <memory>

namespace Gemmule
{
/**
 * The flow that a membrane drives: puts together tension, bending force and arclength constraint, and the
 * part of their stiffness that is implicit in the flow (doc/method.md, "Stability"), and solves Stokes'
 * equations.
 */
template <int dim>
class MembraneFlow
{
public:
  using Triangulation = dealii::parallel::distributed::Triangulation<dim>;

  /** @p parameters and @p model are kept by reference. */
  MembraneFlow(const Triangulation &triangulation, const AllParameters &parameters,
               const MembraneModel &model);

  /** Call after every change of the mesh. Collective. */
  void reinit_mesh() { stokes.reinit_mesh(); }

  /** See StokesSolver. */
  void forget_last_flow() { stokes.forget_last_flow(); }

  /** The membrane whose flow is asked for. */
  struct Membrane
  {
    const CutGeometry<dim> &geometry;
    const SurfaceSolver<dim> *surface;   ///< nullptr: the tension is prescribed
    const MembraneBending<dim> *bending; ///< nullptr: none; has curvature and moment
    double reference_arclength;
  };

  /**
   * Flow at @p time.
   * @param dt step that leads to the next time level with this flow
   * @param old_velocity of the same material points one step ago; nullptr at the start: nothing is implicit
   * Throws SimulationError; ParameterError when an expression of t makes no sense at that time. Collective.
   */
  void solve(double time, double dt, const Membrane &membrane, const CutCellVector<dim> *old_velocity,
             dealii::TimerOutput &timer);

  const StokesSolver<dim> &solver() const { return stokes; }
  /** sigma without the arclength constraint's part, per owned cut cell and quadrature point. */
  const MembranePointValues &own_tension() const { return sigma; }
  /** int sigma over the whole membrane, without that part: a constraint has its own energy, or none.
   * Collective. */
  double tension_energy(const CutGeometry<dim> &geometry) const;
  /** The uniform tension of the arclength constraint; 0 without one. */
  double constraint_tension() const { return constraint != nullptr ? constraint->tension() : 0.; }
  /** sigma with the arclength constraint's part. */
  MembranePointValues tension() const;
  /** Does the motion need tension_velocity()? With an arclength multiplier. */
  bool has_tension_velocity() const
  {
    return parameters.arclength.model == Parameters::ArclengthModel::multiplier;
  }
  /** <u> per unit of the constraint's tension on the cut cells; after a flow with a constraint. */
  const std::vector<MembraneVelocity<dim>> &tension_velocity() const
  {
    return constraint->velocity_of_unit_tension();
  }
  /** Of tension(), over the whole membrane. Collective. */
  double smallest_tension() const;
  /** What limits the step that leads away from the last solution. Collective. */
  TimeStepLimits time_step_limits(const CutGeometry<dim> &geometry) const;

private:
  using Terms = typename StokesSolver<dim>::Terms;

  MembranePointValues tension_of(const Membrane &membrane, double time) const;
  /** Tension that resists short waves of the shape: sigma and the positive part of bending's. */
  MembranePointValues stiff_tension(const MembraneBending<dim> *bending) const;
  MembranePointValues dilatational_modulus(const Membrane &membrane) const;
  /** What damps the fast shape modes of the explicit coupling. */
  void add_semi_implicit_terms(const Membrane &membrane, double dt, const CutCellVector<dim> &old_velocity,
                               Terms &terms) const;
  /** The arclength constraint; nullptr: none. */
  std::shared_ptr<ArclengthConstraint<dim>> make_constraint(const Membrane &membrane, double dt) const;

  const AllParameters &parameters;
  const MembraneModel &model;
  const MPI_Comm communicator;
  std::unique_ptr<dealii::Function<dim>> boundary_velocity, prescribed_tension;
  StokesSolver<dim> stokes;
  MembranePointValues sigma;
  std::shared_ptr<ArclengthConstraint<dim>> constraint; ///< of the last flow; nullptr: none
};
} // namespace Gemmule
