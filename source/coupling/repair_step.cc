// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/coupling/repair_step.h>
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

  template <int dim>
  MPI_Comm communicator_of(const Interface<dim> &interface)
  {
    return interface.level_set().get_dof_handler().get_communicator();
  }
} // namespace

template <int dim>
RepairStep<dim>::RepairStep(const MembraneSnapshot<dim> &level)
    : level(level), membrane(level.patches, level.origin)
{
}

template <int dim>
bool RepairStep<dim>::is_resolved() const
{
  return largest_unresolved_cell(membrane, too_large_curvature) == 0.;
}

template <int dim>
RepairReport RepairStep<dim>::remove_small_features(const double area, Interface<dim> &interface) const
{
  const MPI_Comm communicator = communicator_of(interface);
  const double cell_size = largest_unresolved_cell(membrane, too_large_curvature);
  RepairReport report;
  const auto remove = [&](const double radius)
  {
    report.radius = radius * cell_size;
    report.arclength_before = Gemmule::remove_small_features(level, report.radius, interface, communicator);
  };
  for (unsigned int i = 0; i < repair_radii.size(); ++i)
  {
    remove(repair_radii[i]);
    if (i > 0 && std::abs(interface.geometry().enclosed_volume() / area - 1.) > largest_area_change)
    {
      remove(repair_radii[i - 1]);
      break;
    }
    const auto patches = gather_bare_patches(interface.geometry(), communicator);
    if (largest_unresolved_cell(MembraneProjection<dim>(patches, level.origin), good_curvature) == 0.)
      break;
  }
  return report;
}

template <int dim>
void RepairStep<dim>::carry_over_concentrations(const Interface<dim> &interface,
                                                const MembranePointValues *const curvature,
                                                SurfaceSolver<dim> &surface) const
{
  using Fields = MembraneFields<dim>;
  const MPI_Comm communicator = communicator_of(interface);
  const CutGeometry<dim> &geometry = interface.geometry();
  const auto points = find_repaired_points(membrane, geometry, level.origin, communicator);
  const auto carried = [&](const auto field, const std::vector<double> &densities)
  {
    const auto &weights = level.cloud.weights;
    const double mass = std::inner_product(weights.begin(), weights.end(), densities.begin(), 0.);
    return RepairedConcentration<dim>(membrane, field, mass, geometry, points, communicator);
  };
  surface.initialise(interface, carried(&Fields::concentration, level.cloud.concentration),
                     carried(&Fields::total_concentration, level.cloud.total_concentration), curvature);
}

template class RepairStep<2>;
template class RepairStep<3>;
} // namespace Gemmule
