// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/geometry/narrow_band_level_set.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // In edges of a cell: at a point that is so far from the membrane the level set has the right sign.
  constexpr double beyond_doubt = 0.5;
} // namespace

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
  if (cells.empty())
    return {};
  if (!tree)
  {
    std::vector<typename BoxTree<dim>::Box> boxes;
    for (const auto &cell : cells)
    {
      Point<dim> upper = cell.corner;
      for (unsigned int d = 0; d < dim; ++d)
        upper[d] += cell.size;
      boxes.push_back({cell.corner, upper});
    }
    tree.emplace(std::move(boxes));
  }
  const auto &cell = cells[tree->nearest(x)];
  Point<dim> edge;
  for (unsigned int d = 0; d < dim; ++d)
    edge[d] = std::clamp((x[d] - cell.corner[d]) / cell.size, 0., 1.);
  const double phi = evaluate_polynomial<dim, 3>(cell.level_set, edge).value,
               distance = x.distance(cell.corner + cell.size * Tensor<1, dim>(edge));
  // The band has the whole membrane, so that none of it is between x and the nearest point of the band; that
  // point itself has to be on one side beyond doubt.
  if (std::abs(phi) > std::min(distance, beyond_doubt * cell.size))
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
