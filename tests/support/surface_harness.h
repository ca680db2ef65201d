// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_snapshot.h>
#include <gemmule/surface/surface_step.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <functional>
#include <numeric>

#include "support/level_set_mesh.h"

namespace Gemmule::Testing
{
/** A mesh with a given membrane, and the fields on its cut cells that the surface equations ask for. */
struct SurfaceHarness
{
  using Field = std::function<double(const Point<2> &)>;
  using VectorField = std::function<Tensor<1, 2>(const Point<2> &)>;

  LevelSetMesh<2> mesh;
  Interface<2> interface;
  const CutGeometry<2> &geometry;

  explicit SurfaceHarness(const unsigned int level)
      : mesh(level), interface(mesh.triangulation), geometry(interface.geometry())
  {
  }

  void set_membrane(const Function<2> &distance)
  {
    interface.reinit_mesh();
    interface.interpolate(distance);
    interface.cut();
  }

  CutCellScalar<2> scalar(const Field &field) const
  {
    CutCellScalar<2> result(geometry.cut_cells().size());
    for (unsigned int k = 0; k < result.size(); ++k)
      for (unsigned int i = 0; i < result[k].size(); ++i)
        result[k][i] = field(geometry.cut_cells()[k].physical(TensorLagrange<2, 3>::node(i)));
    return result;
  }

  CutCellVector<2> vector(const VectorField &field) const
  {
    CutCellVector<2> result(geometry.cut_cells().size());
    for (unsigned int k = 0; k < result.size(); ++k)
      for (unsigned int i = 0; i < result[k].size(); ++i)
        result[k][i] = field(geometry.cut_cells()[k].physical(TensorLagrange<2, 3>::node(i)));
    return result;
  }

  /** e1 newer + e2 older of two trace fields on the present geometry. */
  CutCellScalar<2> combine(const double e1, const TraceField<2> &newer, const double e2,
                           const TraceField<2> &older) const
  {
    CutCellScalar<2> result(newer.size());
    for (unsigned int k = 0; k < result.size(); ++k)
      for (unsigned int i = 0; i < result[k].size(); ++i)
      {
        const auto node = TensorLagrange<2, 3>::node(i);
        result[k][i] = e1 * TensorLagrange<2, 2>::value(newer[k], node) +
                       e2 * TensorLagrange<2, 2>::value(older[k], node);
      }
    return result;
  }

  /** The whole membrane of now, with given concentrations, on every rank. */
  MembraneCloud<2> cloud(const Field &concentration, const Field &total_concentration) const
  {
    MembraneCloud<2> cloud;
    for (const auto &cell : geometry.cut_cells())
      for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
      {
        const auto x = cell.physical(cell.surface_points[q]);
        cloud.points.push_back(x);
        cloud.normals.push_back(cell.normals[q]);
        cloud.weights.push_back(cell.surface_weights[q]);
        cloud.concentration.push_back(concentration(x));
        cloud.total_concentration.push_back(total_concentration(x));
      }
    return gather(cloud);
  }

  static MembraneCloud<2> gather(const MembraneCloud<2> &mine)
  {
    MembraneCloud<2> all;
    const auto append = [](auto &target, const auto &source)
    {
      for (const auto &part : Utilities::MPI::all_gather(MPI_COMM_WORLD, source))
        target.insert(target.end(), part.begin(), part.end());
    };
    append(all.points, mine.points);
    append(all.normals, mine.normals);
    append(all.weights, mine.weights);
    append(all.concentration, mine.concentration);
    append(all.total_concentration, mine.total_concentration);
    return all;
  }

  static double mass(const MembraneCloud<2> &cloud, const std::vector<double> &density)
  {
    return std::inner_product(cloud.weights.begin(), cloud.weights.end(), density.begin(), 0.);
  }

  /** Cloud of a trace field as total concentration (for schemes tested by themselves). */
  MembraneCloud<2> cloud(const TraceField<2> &total) const
  {
    auto cloud = MembraneCloud<2>();
    for (unsigned int k = 0; k < geometry.cut_cells().size(); ++k)
    {
      const auto &cell = geometry.cut_cells()[k];
      for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
      {
        cloud.points.push_back(cell.physical(cell.surface_points[q]));
        cloud.normals.push_back(cell.normals[q]);
        cloud.weights.push_back(cell.surface_weights[q]);
        cloud.total_concentration.push_back(TensorLagrange<2, 2>::value(total[k], cell.surface_points[q]));
      }
    }
    cloud.concentration = cloud.total_concentration;
    return gather(cloud);
  }

  /** int over the membrane of a function of the field's value and the position. */
  double integrate(const TraceField<2> &field,
                   const std::function<double(double, const Point<2> &)> &integrand) const
  {
    double sum = 0.;
    for (unsigned int k = 0; k < geometry.cut_cells().size(); ++k)
    {
      const auto &cell = geometry.cut_cells()[k];
      for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
        sum +=
            cell.surface_weights[q] * integrand(TensorLagrange<2, 2>::value(field[k], cell.surface_points[q]),
                                                cell.physical(cell.surface_points[q]));
    }
    return Utilities::MPI::sum(sum, MPI_COMM_WORLD);
  }

  double l2_error(const TraceField<2> &field, const Field &exact) const
  {
    return std::sqrt(integrate(field,
                               [&](const double value, const Point<2> &x)
                               {
                                 const double e = value - exact(x);
                                 return e * e;
                               }));
  }
};
} // namespace Gemmule::Testing
