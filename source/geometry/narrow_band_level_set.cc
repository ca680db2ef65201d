// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/geometry/narrow_band_level_set.h>

#include <deal.II/base/numbers.h>

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
double NarrowBandLevelSet<dim>::with_side(const double distance, const Point<dim> &x) const
{
  if (const auto phi = value(x))
    return std::copysign(distance, *phi);
  if (cloud == nullptr)
    return distance;
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
