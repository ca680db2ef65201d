// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/geometry/narrow_band_level_set.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
NarrowBandLevelSet<dim>::NarrowBandLevelSet(const std::vector<LevelSetCell<dim>> &cells_,
                                            const Point<dim> &origin, const MembraneCloud<dim> *const cloud)
    : cells(cells_), cloud(cloud), map(origin)
{
  for (unsigned int c = 0; c < cells.size(); ++c)
    map.insert(cells[c].corner, cells[c].size, c);
}

template <int dim>
std::optional<double> NarrowBandLevelSet<dim>::value(const Point<dim> &x) const
{
  const int c = map.find(x);
  if (c < 0)
    return {};
  return evaluate_polynomial<dim, 3>(cells[c].level_set, Point<dim>((x - cells[c].corner) / cells[c].size))
      .value;
}

template <int dim>
std::optional<double> NarrowBandLevelSet<dim>::value_at_edge(const Point<dim> &x) const
{
  std::optional<double> phi;
  // Farther away, a cell that is nearer might not be visited.
  double nearest = map.smallest_size();
  map.visit_nearby(x,
                   [&](const unsigned int c)
                   {
                     Point<dim> unit, edge;
                     for (unsigned int d = 0; d < dim; ++d)
                     {
                       unit[d] = (x[d] - cells[c].corner[d]) / cells[c].size;
                       edge[d] = std::clamp(unit[d], 0., 1.);
                     }
                     const double distance = cells[c].size * unit.distance(edge);
                     if (distance >= nearest)
                       return;
                     nearest = distance;
                     phi = evaluate_polynomial<dim, 3>(cells[c].level_set, edge).value;
                   });
  // The band has the whole membrane, so that none of it is between x and the nearest point of the band; that
  // point itself has to be on one side beyond doubt.
  if (phi && std::abs(*phi) > nearest)
    return phi;
  return {};
}

template <int dim>
double NarrowBandLevelSet<dim>::with_side(const double distance, const Point<dim> &x) const
{
  if (const auto phi = value(x))
    return std::copysign(distance, *phi);
  if (cloud == nullptr)
    return distance;
  if (const auto phi = value_at_edge(x))
    return std::copysign(distance, *phi);
  double winding = 0.;
  for (std::size_t i = 0; i < cloud->points.size(); ++i)
  {
    const Tensor<1, dim> difference = cloud->points[i] - x;
    const double norm = difference.norm();
    winding +=
        cloud->weights[i] * (difference * cloud->normals[i]) / (dim == 2 ? norm * norm : norm * norm * norm);
  }
  return std::copysign(distance, (dim - 1) * numbers::PI - winding);
}

template class NarrowBandLevelSet<2>;
template class NarrowBandLevelSet<3>;
} // namespace Gemmule
