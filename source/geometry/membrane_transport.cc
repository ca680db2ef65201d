// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/gather.h>
#include <gemmule/geometry/membrane_transport.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

namespace
{
  template <int dim>
  bool lexicographically_less(const Point<dim> &a, const Point<dim> &b)
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (a[d] != b[d])
        return a[d] < b[d];
    return false;
  }

  template <int dim>
  struct CloudPoint
  {
    double point[dim], normal[dim];
    double weight, concentration, total_concentration;
  };
} // namespace

template <int dim>
std::vector<TransportedFields<dim>> transport_fields(const MembraneMotion<dim> &motion,
                                                     const std::vector<CutCell<dim>> &cut_cells)
{
  using Fields = MembraneFields<dim>;
  const MembraneProjection<dim> &old_membrane = motion.old_membrane();
  std::vector<TransportedFields<dim>> transported(cut_cells.size());
  for (unsigned int c = 0; c < cut_cells.size(); ++c)
    for (unsigned int i = 0; i < Fields::n; ++i)
    {
      const Point<dim> x = cut_cells[c].physical(TensorLagrange<dim, 3>::node(i));
      const auto trajectory = motion.trace_back(x);
      auto &t = transported[c];
      t.advecting_velocity[i] = trajectory.velocity;
      t.displacement[i] = trajectory.displacement;
      const auto old_value = [&](const auto field)
      { return old_membrane.value(trajectory.departure_point, field); };
      t.velocity_1_back[i] = old_value(&Fields::velocity);
      t.concentration_1_back[i] = old_value(&Fields::concentration);
      t.concentration_2_back[i] = old_value(&Fields::concentration_1_back);
      t.concentration_3_back[i] = old_value(&Fields::concentration_2_back);
    }
  return transported;
}

template <int dim>
std::vector<typename MembraneFields<dim>::Scalar>
extend_along_normals(const MembraneProjection<dim> &membrane,
                     typename MembraneFields<dim>::Scalar MembraneFields<dim>::*field,
                     const std::vector<CutCell<dim>> &cut_cells)
{
  std::vector<typename MembraneFields<dim>::Scalar> extended(cut_cells.size());
  for (unsigned int c = 0; c < cut_cells.size(); ++c)
    for (unsigned int i = 0; i < MembraneFields<dim>::n; ++i)
      extended[c][i] =
          membrane.value(membrane.project(cut_cells[c].physical(TensorLagrange<dim, 3>::node(i))), field);
  return extended;
}

template <int dim>
std::vector<MembranePatch<dim>> gather_patches(const std::vector<CutCell<dim>> &cut_cells,
                                               const std::vector<MembraneFields<dim>> &fields,
                                               const MPI_Comm communicator)
{
  AssertDimension(cut_cells.size(), fields.size());
  std::vector<MembranePatch<dim>> local(cut_cells.size());
  for (unsigned int c = 0; c < cut_cells.size(); ++c)
  {
    local[c].corner = cut_cells[c].corner;
    local[c].size = cut_cells[c].size;
    local[c].level_set = cut_cells[c].level_set;
    local[c].fields = fields[c];
  }
  auto all = gather_plain(local, communicator);
  std::sort(all.begin(), all.end(),
            [](const auto &a, const auto &b) { return lexicographically_less(a.corner, b.corner); });
  return all;
}

template <int dim>
std::vector<MembranePatch<dim>> gather_bare_patches(const CutGeometry<dim> &geometry,
                                                    const MPI_Comm communicator)
{
  return gather_patches(geometry.cut_cells(), std::vector<MembraneFields<dim>>(geometry.cut_cells().size()),
                        communicator);
}

template <int dim>
MembraneCloud<dim> bare_cloud(const CutGeometry<dim> &geometry)
{
  MembraneCloud<dim> cloud;
  for (const auto &cell : geometry.cut_cells())
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      cloud.points.push_back(cell.physical(cell.surface_points[q]));
      cloud.normals.push_back(cell.normals[q]);
      cloud.weights.push_back(cell.surface_weights[q]);
    }
  cloud.concentration.assign(cloud.points.size(), 0.);
  cloud.total_concentration.assign(cloud.points.size(), 0.);
  return cloud;
}

template <int dim>
MembraneCloud<dim> gather_cloud(const MembraneCloud<dim> &local, const MPI_Comm communicator)
{
  std::vector<CloudPoint<dim>> packed(local.points.size());
  for (unsigned int i = 0; i < packed.size(); ++i)
  {
    for (unsigned int d = 0; d < dim; ++d)
    {
      packed[i].point[d] = local.points[i][d];
      packed[i].normal[d] = local.normals[i][d];
    }
    packed[i].weight = local.weights[i];
    packed[i].concentration = local.concentration[i];
    packed[i].total_concentration = local.total_concentration[i];
  }
  auto all = gather_plain(packed, communicator);
  std::sort(all.begin(), all.end(),
            [](const auto &a, const auto &b)
            { return std::lexicographical_compare(a.point, a.point + dim, b.point, b.point + dim); });

  MembraneCloud<dim> cloud;
  for (const auto &p : all)
  {
    Point<dim> point;
    Tensor<1, dim> normal;
    for (unsigned int d = 0; d < dim; ++d)
    {
      point[d] = p.point[d];
      normal[d] = p.normal[d];
    }
    cloud.points.push_back(point);
    cloud.normals.push_back(normal);
    cloud.weights.push_back(p.weight);
    cloud.concentration.push_back(p.concentration);
    cloud.total_concentration.push_back(p.total_concentration);
  }
  return cloud;
}

#define GEMMULE_INSTANTIATE(dim)                                                                             \
  template std::vector<TransportedFields<dim>> transport_fields(const MembraneMotion<dim> &,                 \
                                                                const std::vector<CutCell<dim>> &);          \
  template std::vector<MembraneFields<dim>::Scalar> extend_along_normals(                                    \
      const MembraneProjection<dim> &, MembraneFields<dim>::Scalar MembraneFields<dim>::*,                   \
      const std::vector<CutCell<dim>> &);                                                                    \
  template std::vector<MembranePatch<dim>> gather_patches(                                                   \
      const std::vector<CutCell<dim>> &, const std::vector<MembraneFields<dim>> &, MPI_Comm);                \
  template std::vector<MembranePatch<dim>> gather_bare_patches(const CutGeometry<dim> &, MPI_Comm);          \
  template MembraneCloud<dim> bare_cloud(const CutGeometry<dim> &);                                          \
  template MembraneCloud<dim> gather_cloud(const MembraneCloud<dim> &, MPI_Comm);
GEMMULE_INSTANTIATE(2)
GEMMULE_INSTANTIATE(3)
#undef GEMMULE_INSTANTIATE
} // namespace Gemmule
