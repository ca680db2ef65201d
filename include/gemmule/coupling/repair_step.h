// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_projection.h>
#include <gemmule/surface/surface_solver.h>

namespace Gemmule
{
/** What a repair of the membrane has done. */
struct RepairReport
{
  double radius = 0.; ///< what is thinner than its double is gone
  double arclength_before = 0., arclength_after = 0.;
};

/** Takes the membrane of an accepted level to one that the mesh resolves (geometry/membrane_repair.h). */
template <int dim>
class RepairStep
{
public:
  /** @param level of the membrane; kept by reference */
  explicit RepairStep(const MembraneSnapshot<dim> &level);

  /** Does the mesh resolve the membrane? */
  bool is_resolved() const;

  /**
   * Makes the interface the membrane without what is smaller than the cells, topological changes included,
   * and cuts it. The enclosed area is not kept; arclength_after is left open.
   * @param area that the membrane should enclose
   * @throws SimulationError if nothing is left. Collective.
   */
  RepairReport remove_small_features(double area, Interface<dim> &interface) const;

  /**
   * Concentrations of the level on the repaired membrane, with the masses that they had.
   * @param curvature of the interface; nullptr without bending
   * @throws SimulationError. Collective.
   */
  void carry_over_concentrations(const Interface<dim> &interface, const MembranePointValues *curvature,
                                 SurfaceSolver<dim> &surface) const;

private:
  const MembraneSnapshot<dim> &level;
  const MembraneProjection<dim> membrane;
};
} // namespace Gemmule
