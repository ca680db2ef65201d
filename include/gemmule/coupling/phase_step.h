// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/coupling/history.h>
#include <gemmule/coupling/trial_clouds.h>
#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/surface/surface_solver.h>

#include <vector>

namespace Gemmule
{
/** The second part of a step: the phases on the interface that has been moved to level n+1. */
template <int dim>
class PhaseStep
{
public:
  /** Everything is kept by reference. */
  PhaseStep(SurfaceSolver<dim> &surface, const Interface<dim> &interface, const History<dim> &history);

  /**
   * Solves the surface equations.
   * @param membrane projection onto that of level n
   * @param transported from there, on the cut cells of the interface
   * @param curvature of the interface; nullptr without bending
   * @return the concentration at level n+1 that was predicted
   * @throws SimulationError. Collective.
   */
  CutCellScalar<dim> advance(const TimeStep &step, const TrialClouds<dim> &clouds,
                             const MembraneProjection<dim> &membrane,
                             const std::vector<TransportedFields<dim>> &transported,
                             const MembranePointValues *curvature);

private:
  SurfaceSolver<dim> &surface;
  const Interface<dim> &interface;
  const History<dim> &history;
};
} // namespace Gemmule
