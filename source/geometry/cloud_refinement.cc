// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/geometry/cell_level_set.h>
#include <gemmule/geometry/cloud_refinement.h>
#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/geometry/cut_quadrature.h>
#include <gemmule/geometry/narrow_band_level_set.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/non_matching/quadrature_generator.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  /** Measure and masses of some points of a cloud. */
  struct Sums
  {
    double measure = 0., concentration = 0., total_concentration = 0.;

    template <int dim>
    void add(const MembraneCloud<dim> &cloud, const std::size_t i)
    {
      measure += cloud.weights[i];
      concentration += cloud.weights[i] * cloud.concentration[i];
      total_concentration += cloud.weights[i] * cloud.total_concentration[i];
    }
  };

  template <int dim>
  void append(MembraneCloud<dim> &cloud, const Point<dim> &point, const Tensor<1, dim> &normal,
              const double weight, const double concentration, const double total_concentration)
  {
    cloud.points.push_back(point);
    cloud.normals.push_back(normal);
    cloud.weights.push_back(weight);
    cloud.concentration.push_back(concentration);
    cloud.total_concentration.push_back(total_concentration);
  }

  /** The smallest cell of the mesh in each patch, at most the patch itself. */
  template <int dim>
  std::vector<double> smallest_cells(const std::vector<MembranePatch<dim>> &patches,
                                     const CartesianCellMap<dim> &map,
                                     const parallel::distributed::Triangulation<dim> &triangulation)
  {
    std::vector<double> sizes(patches.size());
    double largest = 0.;
    for (unsigned int p = 0; p < patches.size(); ++p)
    {
      sizes[p] = patches[p].size;
      largest = std::max(largest, sizes[p]);
    }
    for (const auto &cell : triangulation.active_cell_iterators())
      // Most cells can be in no patch that is larger.
      if (cell->is_locally_owned() && cell->extent_in_direction(0) < largest)
      {
        const int p = map.find(cell->center());
        if (p >= 0)
          sizes[p] = std::min(sizes[p], cell->extent_in_direction(0));
      }
    Utilities::MPI::min(sizes, triangulation.get_communicator(), sizes);
    return sizes;
  }

  /** The points of one patch by the rules of its parts of the given size; none if there are no such rules. */
  template <int dim>
  MembraneCloud<dim> points_of_patch(const MembranePatch<dim> &patch, const unsigned int n_parts)
  {
    using Basis = TensorLagrange<dim, 3>;
    const hp::QCollection<1> gauss{QGauss<1>(n_cut_gauss_points)};
    NonMatching::QuadratureGenerator<dim> generator(gauss);
    const BoundingBox<dim> box = unit_box<dim>();

    MembraneCloud<dim> cloud;
    CellLevelSet<dim> level_set;
    const double part = 1. / n_parts, size = part * patch.size;
    const unsigned int n = dim == 2 ? n_parts * n_parts : n_parts * n_parts * n_parts;
    for (unsigned int k = 0; k < n; ++k)
    {
      Point<dim> corner; // of the part, in units of the patch
      for (unsigned int d = 0, rest = k; d < dim; ++d, rest /= n_parts)
        corner[d] = part * (rest % n_parts);
      for (unsigned int i = 0; i < Basis::n; ++i)
      {
        const double value = Basis::value(patch.level_set, corner + part * Tensor<1, dim>(Basis::node(i)));
        level_set.nodal[i] = off_zero(value, size) / size;
      }
      if (!generate_cut_quadrature(generator, level_set, box))
        return MembraneCloud<dim>();
      const auto &surface = generator.get_surface_quadrature();
      for (unsigned int q = 0; q < surface.size(); ++q)
      {
        const Point<dim> unit = corner + part * Tensor<1, dim>(surface.point(q));
        const Tensor<1, dim> gradient = level_set.gradient(surface.point(q));
        append(cloud, patch.corner + patch.size * Tensor<1, dim>(unit), gradient / gradient.norm(),
               surface.weight(q) * std::pow(size, dim - 1), Basis::value(patch.fields.concentration, unit),
               Basis::value(patch.fields.total_concentration, unit));
      }
    }
    return cloud;
  }
} // namespace

template <int dim>
std::optional<MembraneCloud<dim>>
refined_cloud(const MembraneSnapshot<dim> &snapshot,
              const parallel::distributed::Triangulation<dim> &triangulation)
{
  const auto &patches = snapshot.patches;
  if (patches.empty()) // on all ranks
    return {};
  CartesianCellMap<dim> map(snapshot.origin);
  for (unsigned int p = 0; p < patches.size(); ++p)
    map.insert(patches[p].corner, patches[p].size, p);
  const std::vector<double> sizes = smallest_cells(patches, map, triangulation);
  std::vector<unsigned int> n_parts(patches.size());
  bool any = false;
  for (unsigned int p = 0; p < patches.size(); ++p)
  {
    n_parts[p] = static_cast<unsigned int>(std::lround(patches[p].size / sizes[p]));
    any = any || n_parts[p] > 1;
  }
  if (!any)
    return {};

  MembraneCloud<dim> result;
  const auto &old = snapshot.cloud;
  const auto keep = [&](const std::size_t i)
  {
    append(result, old.points[i], old.normals[i], old.weights[i], old.concentration[i],
           old.total_concentration[i]);
  };
  std::vector<std::vector<std::size_t>> points_in(patches.size());
  for (std::size_t i = 0; i < old.points.size(); ++i)
  {
    const int p = map.find(old.points[i]);
    if (p >= 0 && n_parts[p] > 1)
      points_in[p].push_back(i);
    else
      keep(i);
  }
  for (unsigned int p = 0; p < patches.size(); ++p)
    if (!points_in[p].empty())
    {
      Sums replaced, sums;
      for (const std::size_t i : points_in[p])
        replaced.add(old, i);
      const MembraneCloud<dim> points = points_of_patch(patches[p], n_parts[p]);
      for (std::size_t i = 0; i < points.points.size(); ++i)
        sums.add(points, i);
      // The rules of a patch that is hardly more than touched need not agree: no accuracy is at stake there.
      if (!(std::abs(sums.measure - replaced.measure) < 0.01 * replaced.measure))
      {
        for (const std::size_t i : points_in[p])
          keep(i);
        continue;
      }
      // Masses by a constant, not by a factor: where a concentration changes its sign, that has no bound.
      const double stretch = replaced.measure / sums.measure,
                   f = (replaced.concentration - stretch * sums.concentration) / replaced.measure,
                   f_total =
                       (replaced.total_concentration - stretch * sums.total_concentration) / replaced.measure;
      for (std::size_t i = 0; i < points.points.size(); ++i)
        append(result, points.points[i], points.normals[i], stretch * points.weights[i],
               points.concentration[i] + f, points.total_concentration[i] + f_total);
    }
  return result;
}

template std::optional<MembraneCloud<2>> refined_cloud(const MembraneSnapshot<2> &,
                                                       const parallel::distributed::Triangulation<2> &);
template std::optional<MembraneCloud<3>> refined_cloud(const MembraneSnapshot<3> &,
                                                       const parallel::distributed::Triangulation<3> &);
} // namespace Gemmule
