// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/stokes_solver.h>
#include <gemmule/flow/tension_force.h>
#include <gemmule/geometry/interface.h>
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
  Interface<dim> interface;
  const CutGeometry<dim> &geometry;
  StokesSolver<dim> solver;
  MembranePointValues tension;

  FlowOnCircle(const unsigned int level, const Point<dim> &center, const double viscosity_ratio = 1.,
               const std::function<bool(const Point<dim> &)> &refine = {}, const double capillary_number = 1.)
      : mesh(level), center(center), fluid{capillary_number, viscosity_ratio}, interface(mesh.triangulation),
        geometry(interface.geometry()), solver(mesh.triangulation, fluid, directly_solved())
  {
    if (refine)
      mesh.refine_where(refine);
    set_membrane(Functions::SignedDistance::Sphere<dim>(center, radius));
    solver.reinit_mesh();
  }

  void set_membrane(const Function<dim> &distance)
  {
    interface.reinit_mesh();
    interface.interpolate(distance);
    interface.cut();
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

  static Parameters::Flow directly_solved()
  {
    Parameters::Flow parameters;
    parameters.solver = Parameters::FlowSolver::direct;
    return parameters;
  }

  /** The flow that the tension and other @p terms drive. */
  void solve(const Function<dim> &boundary_velocity, typename StokesSolver<dim>::Terms terms = {})
  {
    terms.push_back(std::make_shared<TensionForce<dim>>(tension, fluid.capillary_number));
    solver.prepare(geometry, boundary_velocity, terms);
    solver.solve();
  }

  /** At the vertices, for a pressure of mean zero that is constant on either side of the membrane. */
  double largest_pressure_error(const double jump) const
  {
    LinearAlgebra::distributed::Vector<double> values;
    solver.interpolate(values);
    const auto &fe = solver.dof_handler().get_fe();
    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
    const auto pressure_dofs = lexicographic_cell_dofs(fe, dim);
    const double inside_part =
        (dim == 2 ? numbers::PI * std::pow(radius, 2) : 4. / 3. * numbers::PI * std::pow(radius, 3)) /
        std::pow(2., dim);
    double largest_error = 0.;
    for (const auto &cell : solver.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned())
      {
        cell->get_dof_indices(dofs);
        for (const unsigned int i : cell->vertex_indices())
        {
          const bool inside = cell->vertex(i).distance(center) < radius;
          const double exact = jump * ((inside ? 1. : 0.) - inside_part);
          largest_error = std::max(largest_error, std::abs(values(dofs[pressure_dofs[i]]) - exact));
        }
      }
    return Utilities::MPI::max(largest_error, MPI_COMM_WORLD);
  }

  /** Integral over the membrane of a function of position, normal and <u>. */
  double integrate(const std::function<double(const Point<dim> &, const Tensor<1, dim> &,
                                              const Tensor<1, dim> &)> &f) const
  {
    return integrate(f, solver);
  }
  double integrate(
      const std::function<double(const Point<dim> &, const Tensor<1, dim> &, const Tensor<1, dim> &)> &f,
      const StokesSolver<dim> &flow) const
  {
    double sum = 0.;
    for (unsigned int k = 0; k < geometry.cut_cells().size(); ++k)
    {
      const auto &cell = geometry.cut_cells()[k];
      for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
        sum += cell.surface_weights[q] * f(cell.physical(cell.surface_points[q]), cell.normals[q],
                                           flow.membrane_velocity()[k].value(cell.surface_points[q]));
    }
    return Utilities::MPI::sum(sum, MPI_COMM_WORLD);
  }

  /** L2 error of <u> on the membrane. */
  double error(const std::function<Tensor<1, dim>(const Point<dim> &)> &exact) const
  {
    return error(exact, solver);
  }
  double error(const std::function<Tensor<1, dim>(const Point<dim> &)> &exact,
               const StokesSolver<dim> &flow) const
  {
    return std::sqrt(integrate([&](const Point<dim> &p, const Tensor<1, dim> &, const Tensor<1, dim> &u)
                               { return (u - exact(p)).norm_square(); },
                               flow));
  }
};
} // namespace Gemmule::Testing
