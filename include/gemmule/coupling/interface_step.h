// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/coupling/history.h>
#include <gemmule/coupling/mesh_policy.h>
#include <gemmule/coupling/reference_measures.h>
#include <gemmule/coupling/trial_clouds.h>
#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_motion.h>
#include <gemmule/parameters/membrane.h>

#include <deal.II/base/timer.h>
#include <deal.II/distributed/tria.h>

namespace Gemmule
{
/**
 * The first part of a step: the interface moves from level n to level n+1 with the extrapolated velocity; the
 * enclosed area is restored by a shift, and with a multiplier the arclength by a change of the motion.
 */
template <int dim>
class InterfaceStep
{
public:
  using Triangulation = dealii::parallel::distributed::Triangulation<dim>;

  /** Everything is kept by reference. */
  InterfaceStep(Interface<dim> &interface, const Triangulation &triangulation,
                const MeshPolicy<dim> &mesh_policy, const History<dim> &history,
                const ReferenceMeasures &reference, const Parameters::ArclengthConstraint &arclength,
                dealii::TimerOutput &timer);

  /** The arclength that the motion aims at. */
  struct Aim
  {
    double target = 0.;         ///< arclength wanted at level n+1
    double predicted = 0.;      ///< the one that motion is made for: differs by the error of the prediction
    bool is_adjustable = false; ///< does the motion change the arclength?
  };

  /**
   * Changes @p motion such that it leads to the arclength that a multiplier gives level n+1; does nothing
   * without one. Before the mesh is adapted to the motion.
   */
  Aim aim(MembraneMotion<dim> &motion, const TrialClouds<dim> &clouds) const;

  /**
   * Moves the interface, on a mesh that is adapted to the motion, and cuts the cells.
   * @param aim of aim(); where the length is missed the motion is changed
   * @throws SimulationError where the membrane may not be there. Collective.
   */
  void move(MembraneMotion<dim> &motion, const TrialClouds<dim> &clouds, Aim aim);

  /**
   * Cuts the cells by the level set and shifts it to the reference area.
   * @throws SimulationError where the membrane may not be there. Collective.
   */
  void cut();

  /** Length by which the last cut() has shifted the membrane inwards. */
  double area_correction() const { return last_area_correction; }

private:
  void move_once(const MembraneMotion<dim> &motion, const TrialClouds<dim> &clouds);
  void check_cut_cells() const;

  Interface<dim> &interface;
  const Triangulation &triangulation;
  const MeshPolicy<dim> &mesh_policy;
  const History<dim> &history;
  const ReferenceMeasures &reference;
  const Parameters::ArclengthConstraint &arclength;
  dealii::TimerOutput &timer;
  double last_area_correction = 0.;
};
} // namespace Gemmule
