// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/function_lib.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/la_parallel_vector.h>
#include <deal.II/numerics/vector_tools_interpolate.h>

#include <functional>

namespace Gemmule::Testing
{
using namespace dealii;

/** The box [-1, 1]^dim with 2^level cells per edge, and a Q3 level set on it. */
template <int dim>
struct LevelSetMesh
{
  parallel::distributed::Triangulation<dim> triangulation;
  FE_Q<dim> fe;
  DoFHandler<dim> dof_handler;
  AffineConstraints<double> constraints;
  LinearAlgebra::distributed::Vector<double> level_set;

  explicit LevelSetMesh(const unsigned int level)
      : triangulation(MPI_COMM_WORLD, Triangulation<dim>::MeshSmoothing::none,
                      parallel::distributed::Triangulation<dim>::Settings::default_setting),
        fe(3), dof_handler(triangulation)
  {
    GridGenerator::hyper_cube(triangulation, -1., 1.);
    triangulation.refine_global(level);
  }

  /** Refines once the cells whose centre satisfies @p criterion. */
  void refine_where(const std::function<bool(const Point<dim> &)> &criterion)
  {
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned() && criterion(cell->center()))
        cell->set_refine_flag();
    triangulation.execute_coarsening_and_refinement();
  }

  void interpolate(const Function<dim> &function)
  {
    dof_handler.distribute_dofs(fe);
    IndexSet relevant;
    DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
    constraints.reinit(relevant);
    DoFTools::make_hanging_node_constraints(dof_handler, constraints);
    constraints.close();
    LinearAlgebra::distributed::Vector<double> owned(dof_handler.locally_owned_dofs(), relevant,
                                                     MPI_COMM_WORLD);
    VectorTools::interpolate(dof_handler, function, owned);
    owned.update_ghost_values();
    constraints.distribute(owned);
    owned.update_ghost_values();
    level_set = owned;
    level_set.update_ghost_values();
  }
};
} // namespace Gemmule::Testing
