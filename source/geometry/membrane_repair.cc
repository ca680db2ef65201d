// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/geometry/membrane_repair.h>
#include <gemmule/geometry/membrane_transport.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // Two sheets in one cell: cosine of the angle between their normals.
  constexpr double opposite = -0.5;
  // What is farther from the other membrane than this part of a cell counts as changed.
  constexpr double changed = 0.05;
  constexpr double neighborhood_in_cells = 8.;
  constexpr double largest_local_factor = 0.25;

  template <int dim>
  double largest_cell(const std::vector<MembranePatch<dim>> &patches)
  {
    double largest = 0.;
    for (const auto &patch : patches)
      largest = std::max(largest, patch.size);
    return largest;
  }
} // namespace

template <int dim>
double largest_unresolved_cell(const MembraneProjection<dim> &membrane, const double largest_curvature)
{
  const auto &samples = membrane.samples();
  double largest = 0.;
  for (std::size_t first = 0, i = 0; i < samples.size(); ++i)
  {
    const double h = membrane.get_patches()[samples[i].patch].size;
    // the samples of a patch follow each other
    if (samples[i].patch != samples[first].patch)
      first = i;
    bool is_resolved = std::abs(membrane.curvature(samples[i])) * h <= largest_curvature;
    for (std::size_t j = first; j < i; ++j)
      is_resolved = is_resolved && samples[i].normal * samples[j].normal >= opposite;
    if (!is_resolved)
      largest = std::max(largest, h);
  }
  return largest;
}

template <int dim>
double remove_small_features(const MembraneSnapshot<dim> &membrane, const double radius,
                             Interface<dim> &interface, const MPI_Comm communicator)
{
  const CutGeometry<dim> &geometry = interface.geometry();
  const double width = 4. * radius; // the membrane moves by twice the radius at most
  interface.set_distance(MembraneProjection<dim>(membrane.patches, membrane.origin),
                         NarrowBandLevelSet<dim>(membrane.narrow_band, membrane.origin, &membrane.cloud),
                         width);
  interface.cut();
  const double measure = geometry.measure();
  for (const double distance : {radius, -2. * radius, radius})
  {
    interface.shift(-distance);
    interface.cut();
    const auto patches = gather_bare_patches(geometry, communicator);
    const auto cloud = gather_cloud(bare_cloud(geometry), communicator);
    const auto band = interface.level_set().gather_narrow_band();
    interface.set_distance(MembraneProjection<dim>(patches, membrane.origin),
                           NarrowBandLevelSet<dim>(band, membrane.origin, &cloud), width);
  }
  interface.cut();
  return measure;
}

template <int dim>
std::vector<Point<dim>> find_repaired_points(const MembraneProjection<dim> &old_membrane,
                                             const CutGeometry<dim> &geometry, const Point<dim> &origin,
                                             const MPI_Comm communicator)
{
  const auto patches = gather_bare_patches(geometry, communicator);
  const MembraneProjection<dim> new_membrane(patches, origin);
  const double far = changed * largest_cell(old_membrane.get_patches());
  std::vector<Point<dim>> points;
  const auto compare = [&](const MembraneProjection<dim> &one, const MembraneProjection<dim> &other)
  {
    for (const auto &sample : one.samples())
      if (std::abs(other.project(sample.point).distance) > far)
        points.push_back(sample.point);
  };
  compare(old_membrane, new_membrane);
  compare(new_membrane, old_membrane);
  return points;
}

template <int dim>
RepairedConcentration<dim>::RepairedConcentration(const MembraneProjection<dim> &old_membrane,
                                                  const Field field, const double mass,
                                                  const CutGeometry<dim> &geometry,
                                                  const std::vector<Point<dim>> &repaired_points,
                                                  const MPI_Comm communicator)
    : old_membrane(old_membrane), field(field),
      neighborhood(neighborhood_in_cells * largest_cell(old_membrane.get_patches())),
      repaired_points(repaired_points)
{
  double carried_mass = 0., weighted_mass = 0.;
  for (const auto &cell : geometry.cut_cells())
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      const Point<dim> x = cell.physical(cell.surface_points[q]);
      const double part = cell.surface_weights[q] * carried(x);
      carried_mass += part;
      weighted_mass += part * weight(x);
    }
  carried_mass = Utilities::MPI::sum(carried_mass, communicator);
  weighted_mass = Utilities::MPI::sum(weighted_mass, communicator);
  const double missing = mass - carried_mass;
  is_local = std::abs(missing) <= largest_local_factor * std::abs(weighted_mass);
  if (!is_local && std::abs(carried_mass) < 1e-3 * std::abs(mass))
    throw SimulationError("The concentrations on the repaired membrane have no mass.");
  factor = missing == 0. ? 0. : missing / (is_local ? weighted_mass : carried_mass);
}

template <int dim>
double RepairedConcentration<dim>::carried(const Point<dim> &x) const
{
  return old_membrane.value(old_membrane.project(x), field);
}

template <int dim>
double RepairedConcentration<dim>::weight(const Point<dim> &x) const
{
  double distance_square = std::numeric_limits<double>::max();
  for (const auto &point : repaired_points)
    distance_square = std::min(distance_square, x.distance_square(point));
  return std::exp(-distance_square / (neighborhood * neighborhood));
}

template <int dim>
double RepairedConcentration<dim>::value(const Point<dim> &x, const unsigned int) const
{
  return carried(x) * (1. + factor * (is_local ? weight(x) : 1.));
}

#define GEMMULE_INSTANTIATE(dim)                                                                             \
  template double largest_unresolved_cell(const MembraneProjection<dim> &, double);                          \
  template double remove_small_features(const MembraneSnapshot<dim> &, double, Interface<dim> &, MPI_Comm);  \
  template std::vector<Point<dim>> find_repaired_points(                                                     \
      const MembraneProjection<dim> &, const CutGeometry<dim> &, const Point<dim> &, MPI_Comm);              \
  template class RepairedConcentration<dim>;
GEMMULE_INSTANTIATE(2)
GEMMULE_INSTANTIATE(3)
#undef GEMMULE_INSTANTIATE
} // namespace Gemmule
