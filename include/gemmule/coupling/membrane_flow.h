// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/semi_implicit_tension.h>
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
 * part of their stiffness that is implicit in the flow (doc/method.md, "Time"), and solves Stokes' equations.
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

  /** The membrane whose flow is asked for. */
  struct Membrane
  {
    const CutGeometry<dim> &geometry;
    const SurfaceSolver<dim> *surface; ///< nullptr: the tension is prescribed
    MembraneBending<dim> *bending;     ///< nullptr: none; needs its curvature, gets its moment
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
  /** sigma with the arclength constraint's part, per owned cut cell and quadrature point. */
  const MembranePointValues &tension() const { return total_tension; }
  /** Over the whole membrane. Collective. */
  double smallest_tension() const;
  /** What limits the step that leads away from the last solution. Collective. */
  TimeStepLimits time_step_limits(const CutGeometry<dim> &geometry) const;

private:
  MembranePointValues tension_of(const Membrane &membrane, double time) const;
  /** Tension that resists short waves of the shape: sigma and the positive part of bending's. */
  MembranePointValues stiff_tension(const MembraneBending<dim> *bending) const;
  MembranePointValues dilatational_modulus(const Membrane &membrane) const;
  void solve_with_constraint(const Membrane &membrane, double dt, const BendingForce<dim> *bending_force);

  const AllParameters &parameters;
  const MembraneModel &model;
  const MPI_Comm communicator;
  std::unique_ptr<dealii::Function<dim>> boundary_velocity, prescribed_tension;
  StokesSolver<dim> stokes;
  MembranePointValues total_tension;
};
} // namespace Gemmule
