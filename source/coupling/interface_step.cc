// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/coupling/interface_step.h>
#include <gemmule/coupling/wall_cells.h>
#include <gemmule/geometry/narrow_band_level_set.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // |grad phi| may drift this far from one before phi is made a distance again.
  constexpr double largest_distance_drift = 0.05;
  // A multiplier keeps the arclength to this part of it.
  constexpr double arclength_tolerance = 1e-7;
  constexpr unsigned int largest_number_of_corrections = 3;
  // A given reference arclength is approached by at most this part of it per step.
  constexpr double largest_arclength_change = 1e-3;

  /** The arclength of the next level: the reference, if it is not too far. */
  template <int dim>
  double next_arclength(const MembraneCloud<dim> &membrane, const double reference)
  {
    const double present = std::accumulate(membrane.weights.begin(), membrane.weights.end(), 0.);
    const double largest_change = largest_arclength_change * reference;
    return std::clamp(reference, present - largest_change, present + largest_change);
  }
} // namespace

template <int dim>
InterfaceStep<dim>::InterfaceStep(Interface<dim> &interface, const Triangulation &triangulation,
                                  const MeshPolicy<dim> &mesh_policy, const History<dim> &history,
                                  const ReferenceMeasures &reference,
                                  const Parameters::ArclengthConstraint &arclength, TimerOutput &timer)
    : interface(interface), triangulation(triangulation), mesh_policy(mesh_policy), history(history),
      reference(reference), arclength(arclength), timer(timer)
{
}

template <int dim>
typename InterfaceStep<dim>::Aim InterfaceStep<dim>::aim(MembraneMotion<dim> &motion,
                                                         const TrialClouds<dim> &clouds) const
{
  Aim aim;
  if (arclength.model != Parameters::ArclengthModel::multiplier)
    return aim;
  aim.target = aim.predicted = next_arclength(history.level_n().cloud, reference.arclength);
  aim.is_adjustable = motion.fit_measure(clouds.level_n(), aim.predicted, reference.area) != 0.;
  return aim;
}

template <int dim>
void InterfaceStep<dim>::move(MembraneMotion<dim> &motion, const TrialClouds<dim> &clouds, Aim aim)
{
  move_once(motion, clouds);
  // The length is predicted up to the error of the level set; where that is too large, aim differently.
  for (unsigned int i = 0; i < largest_number_of_corrections && aim.is_adjustable; ++i)
  {
    const double excess = interface.geometry().measure() - aim.target;
    if (std::abs(excess) < arclength_tolerance * reference.arclength)
      break;
    aim.predicted -= excess;
    motion.fit_measure(clouds.level_n(), aim.predicted, reference.area);
    move_once(motion, clouds);
  }
}

template <int dim>
void InterfaceStep<dim>::move_once(const MembraneMotion<dim> &motion, const TrialClouds<dim> &clouds)
{
  {
    TimerOutput::Scope scope(timer, "geometry: level set");
    const MembraneSnapshot<dim> &old = history.level_n();
    interface.move(motion, NarrowBandLevelSet<dim>(old.narrow_band, old.origin, &clouds.level_n()),
                   motion.old_membrane().distance_drift() > largest_distance_drift);
  }
  try
  {
    cut();
    if (!interface.is_accurate())
      throw StepBreakdown("The membrane moves by more than a cell in one time step: the step is too long.");
  }
  catch (const SimulationError &)
  {
    // Should a sign far from the membrane be wrong, it must not stay for the next try.
    interface.forget_far_nodes();
    throw;
  }
}

template <int dim>
void InterfaceStep<dim>::cut()
{
  TimerOutput::Scope scope(timer, "geometry: cut cells");
  last_area_correction = 0.;
  interface.cut();
  check_cut_cells();
  last_area_correction = interface.shift_to_volume(reference.area);
  if (last_area_correction != 0.)
    check_cut_cells();
}

template <int dim>
void InterfaceStep<dim>::check_cut_cells() const
{
  if (count_wall_cells(triangulation, interface.geometry(), triangulation.get_communicator()).not_outside > 0)
    throw SimulationError("The membrane has reached the wall of the box. Use a larger box, or end earlier.");
  mesh_policy.check_refined(interface.geometry());
}

template class InterfaceStep<2>;
template class InterfaceStep<3>;
} // namespace Gemmule
