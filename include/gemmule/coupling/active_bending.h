// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/coupling/grid_scale_rigidity.h>
#include <gemmule/geometry/interface.h>
#include <gemmule/model/bending_model.h>
#include <gemmule/surface/membrane_bending.h>
#include <gemmule/surface/surface_solver.h>

#include <deal.II/base/timer.h>
#include <deal.II/grid/tria.h>

#include <memory>

namespace Gemmule
{
/**
 * Curvature and bending of the membrane for as long as it resists bending, by the rigidity of its phases or
 * by that of the grid scale alone. Whether there is MembraneBending follows from the state and not from its
 * history: a resumed run has to find the same.
 */
template <int dim>
class ActiveBending
{
public:
  /** All but @p grid_scale_coefficient (GridScaleRigidity) is kept by reference. */
  ActiveBending(const dealii::Triangulation<dim> &triangulation, const BendingModel &model,
                double grid_scale_coefficient, dealii::TimerOutput &timer);

  /** Call after every change of the mesh. Collective. */
  void reinit_mesh();

  /**
   * Curvature of the membrane of @p interface, which must stay until the next call, if the membrane resists
   * bending. Throws SimulationError. Collective.
   */
  void compute_curvature(const Interface<dim> &interface);

  /** At the quadrature points of the locally owned cut cells; nullptr without bending. */
  const MembranePointValues *curvature() const
  {
    return bending != nullptr ? &bending->curvature() : nullptr;
  }

  /**
   * Moment and energy, if the membrane resists bending: the last thing that is computed before the flow.
   * @param surface has the concentrations on the membrane of compute_curvature(); nullptr: a single phase
   * Collective.
   */
  void compute_moment(const SurfaceSolver<dim> *surface);

  /** nullptr as long as the membrane does not resist bending. */
  const MembraneBending<dim> *get() const { return bending.get(); }

  GridScaleRigidity &grid_scale() { return law; }
  const GridScaleRigidity &grid_scale() const { return law; }

private:
  const dealii::Triangulation<dim> &triangulation;
  const BendingModel &model;
  GridScaleRigidity law;
  dealii::TimerOutput &timer;
  std::unique_ptr<MembraneBending<dim>> bending;
};
} // namespace Gemmule
