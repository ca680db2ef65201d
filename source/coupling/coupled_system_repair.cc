// SPDX-License-Identifier: LGPL-2.1-or-later
// A new beginning from a membrane that the mesh no longer resolves.
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/geometry/membrane_repair.h>
#include <gemmule/geometry/membrane_transport.h>

#include <array>
#include <cmath>
#include <numeric>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // Radius of what is removed, in cells: two sheets that share a cell are less than 1.4 cells apart. Where
  // that leaves shapes that are not resolved either, more has to go.
  constexpr std::array<double, 3> repair_radii = {{0.75, 1.5, 3.}};
  // Not so much that the area would have to be corrected by more than this part of it.
  constexpr double largest_area_change = 0.04;
  // Curvature times cell size above which a membrane is repaired, and with which a repair is content: the
  // tips of a thread that was cut have the radius of the repair.
  constexpr double too_large_curvature = 1., good_curvature = 0.75;
} // namespace

template <int dim>
bool CoupledSystem<dim>::membrane_is_resolved() const
{
  return largest_unresolved_cell(MembraneProjection<dim>(history.level_n().patches, origin),
                                 too_large_curvature) == 0.;
}

template <int dim>
RepairReport CoupledSystem<dim>::repair_membrane()
{
  const double old_reference = arclength_0;
  try
  {
    return begin_from_repaired_membrane();
  }
  catch (...)
  {
    arclength_0 = old_reference;
    // They may belong to a shape that is to be forgotten.
    interface.forget_far_nodes();
    throw;
  }
}

template <int dim>
RepairReport CoupledSystem<dim>::begin_from_repaired_membrane()
{
  const CutGeometry<dim> &geometry = interface.geometry();
  const MembraneSnapshot<dim> &old = history.level_n();
  const MembraneProjection<dim> old_membrane(old.patches, origin);
  RepairReport report;
  {
    TimerOutput::Scope scope(timer_output, "geometry: repair");
    const double cell_size = largest_unresolved_cell(old_membrane, too_large_curvature);
    const auto remove = [&](const double radius)
    {
      report.radius = radius * cell_size;
      report.arclength_before = remove_small_features(old, report.radius, interface, communicator);
    };
    for (unsigned int i = 0; i < repair_radii.size(); ++i)
    {
      remove(repair_radii[i]);
      if (i > 0 && std::abs(geometry.enclosed_volume() / area_0 - 1.) > largest_area_change)
      {
        remove(repair_radii[i - 1]);
        break;
      }
      const auto patches = gather_bare_patches(geometry, communicator);
      if (largest_unresolved_cell(MembraneProjection<dim>(patches, origin), good_curvature) == 0.)
        break;
    }
  }
  cut_mesh();
  report.arclength_after = geometry.measure();
  const MembranePointValues *const curvature = compute_curvature();
  if (surface)
  {
    using Fields = MembraneFields<dim>;
    const auto points = find_repaired_points(old_membrane, geometry, origin, communicator);
    const auto carry_over = [&](const auto field, const std::vector<double> &densities)
    {
      const auto &weights = old.cloud.weights;
      const double mass = std::inner_product(weights.begin(), weights.end(), densities.begin(), 0.);
      return RepairedConcentration<dim>(old_membrane, field, mass, geometry, points, communicator);
    };
    surface->initialise(interface, carry_over(&Fields::concentration, old.cloud.concentration),
                        carry_over(&Fields::total_concentration, old.cloud.total_concentration), curvature);
  }
  // The length of sheets that have merged cannot come back: the constraint holds for what is left.
  arclength_0 *= report.arclength_after / report.arclength_before;
  solve_flow(history.time(), parameters.time_stepping.initial_step, nullptr);
  n_steps_on_mesh = 0;
  start_history(history.time());
  sample_flow();
  return report;
}

template bool CoupledSystem<2>::membrane_is_resolved() const;
template bool CoupledSystem<3>::membrane_is_resolved() const;
template RepairReport CoupledSystem<2>::repair_membrane();
template RepairReport CoupledSystem<3>::repair_membrane();
template RepairReport CoupledSystem<2>::begin_from_repaired_membrane();
template RepairReport CoupledSystem<3>::begin_from_repaired_membrane();
} // namespace Gemmule
