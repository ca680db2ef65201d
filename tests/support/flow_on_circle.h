#pragma once

#include <gemmule/flow/stokes_solver.h>
#include <gemmule/parameters/discretisation.h>
#include <gemmule/parameters/fluid.h>

#include <deal.II/base/function_signed_distance.h>

#include <cmath>
#include <functional>

#include "support/level_set_mesh.h"

namespace Gemmule::Testing
{
/** Stokes flow around a circle (sphere) of radius 0.45 in the box [-1, 1]^dim. */
template <int dim>
struct FlowOnCircle
{
  static constexpr double radius = 0.45;

  LevelSetMesh<dim> mesh;
  Point<dim> center;
  Parameters::Fluid fluid;
  CutGeometry<dim> geometry;
  StokesSolver<dim> solver;
  MembraneScalar tension;

  FlowOnCircle(const unsigned int level, const Point<dim> &center, const double viscosity_ratio = 1.,
               const std::function<bool(const Point<dim> &)> &refine = {}, const double capillary_number = 1.)
      : mesh(level), center(center), fluid{capillary_number, viscosity_ratio},
        solver(mesh.triangulation, fluid, Parameters::Flow())
  {
    if (refine)
      mesh.refine_where(refine);
    mesh.interpolate(Functions::SignedDistance::Sphere<dim>(center, radius));
    geometry.reinit(mesh.dof_handler, mesh.level_set);
    solver.reinit_mesh();
  }

  void set_tension(const std::function<double(const Point<dim> &)> &sigma)
  {
    tension.clear();
    for (const auto &cell : geometry.cut_cells())
    {
      tension.emplace_back();
      for (const auto &p : cell.surface_points)
        tension.back().push_back(sigma(cell.physical(p)));
    }
  }

  void solve(const Function<dim> &boundary_velocity, const ArclengthPenalty *penalty = nullptr)
  {
    solver.prepare(geometry, boundary_velocity);
    solver.solve(tension, penalty);
  }

  /** Integral over the membrane of a function of position, normal and <u>. */
  double integrate(const std::function<double(const Point<dim> &, const Tensor<1, dim> &,
                                              const Tensor<1, dim> &)> &f) const
  {
    double sum = 0.;
    for (unsigned int k = 0; k < geometry.cut_cells().size(); ++k)
    {
      const auto &cell = geometry.cut_cells()[k];
      for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
        sum += cell.surface_weights[q] * f(cell.physical(cell.surface_points[q]), cell.normals[q],
                                           solver.membrane_velocity()[k].value(cell.surface_points[q]));
    }
    return Utilities::MPI::sum(sum, MPI_COMM_WORLD);
  }

  /** L2 error of <u> on the membrane. */
  double error(const std::function<Tensor<1, dim>(const Point<dim> &)> &exact) const
  {
    return std::sqrt(integrate([&](const Point<dim> &p, const Tensor<1, dim> &, const Tensor<1, dim> &u)
                               { return (u - exact(p)).norm_square(); }));
  }
};
} // namespace Gemmule::Testing
