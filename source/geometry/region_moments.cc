// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/geometry/region_moments.h>

#include <deal.II/base/mpi.h>
#include <deal.II/grid/tria.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
double RegionMoments<dim>::deformation() const
{
  const double a = std::sqrt(second_moments[0]), b = std::sqrt(second_moments[1]);
  return (a - b) / (a + b);
}

template <int dim>
RegionMoments<dim> compute_region_moments(const Triangulation<dim> &triangulation,
                                          const CutGeometry<dim> &geometry)
{
  // volume, first moments, second moments about the origin
  std::array<double, 1 + 2 * dim> sums{};
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && geometry.location(cell->active_cell_index()) == CellLocation::inside)
    {
      const double h = cell->extent_in_direction(0), volume = std::pow(h, dim);
      const Point<dim> center = cell->center();
      sums[0] += volume;
      for (unsigned int d = 0; d < dim; ++d)
      {
        sums[1 + d] += volume * center[d];
        sums[1 + dim + d] += volume * (center[d] * center[d] + h * h / 12.);
      }
    }
  for (const auto &cut : geometry.cut_cells())
    for (unsigned int q = 0; q < cut.bulk_points[0].size(); ++q)
    {
      const Point<dim> x = cut.physical(cut.bulk_points[0][q]);
      const double weight = cut.bulk_weights[0][q];
      sums[0] += weight;
      for (unsigned int d = 0; d < dim; ++d)
      {
        sums[1 + d] += weight * x[d];
        sums[1 + dim + d] += weight * x[d] * x[d];
      }
    }
  const ArrayView<double> view(sums.data(), sums.size());
  Utilities::MPI::sum(ArrayView<const double>(sums.data(), sums.size()), triangulation.get_communicator(),
                      view);

  RegionMoments<dim> moments;
  moments.volume = sums[0];
  for (unsigned int d = 0; d < dim; ++d)
  {
    moments.centroid[d] = sums[1 + d] / sums[0];
    moments.second_moments[d] = sums[1 + dim + d] - sums[0] * moments.centroid[d] * moments.centroid[d];
  }
  return moments;
}

template struct RegionMoments<2>;
template struct RegionMoments<3>;
template RegionMoments<2> compute_region_moments(const Triangulation<2> &, const CutGeometry<2> &);
template RegionMoments<3> compute_region_moments(const Triangulation<3> &, const CutGeometry<3> &);
} // namespace Gemmule
