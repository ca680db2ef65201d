// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/flow/unfitted_stokes_space.h>

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>

#include <algorithm>
#include <limits>

namespace Gemmule
{
using namespace dealii;

template <int dim>
UnfittedStokesSpace<dim>::UnfittedStokesSpace(const parallel::distributed::Triangulation<dim> &triangulation)
    : triangulation(triangulation), element(FE_Q<dim>(2), dim, FE_Q<dim>(1), 1), handler(triangulation)
{
}

template <int dim>
void UnfittedStokesSpace<dim>::reinit_mesh()
{
  handler.distribute_dofs(element);
  constrain_hanging_nodes();
  boundary_data.reinit(handler, hanging_nodes);

  const unsigned int n_cells = triangulation.n_active_cells();
  owned.clear();
  sizes.assign(n_cells, 0.);
  levels.assign(n_cells, 0);
  boundary.assign(n_cells, false);
  dofs.resize(n_cells);

  std::vector<unsigned int> order;
  for (unsigned int c = 0; c <= dim; ++c)
    for (const unsigned int i : lexicographic_cell_dofs(handler.get_fe(), c))
      order.push_back(i);
  std::vector<types::global_dof_index> unordered(element.n_dofs_per_cell());
  for (const auto &cell : handler.active_cell_iterators())
  {
    const unsigned int index = cell->active_cell_index();
    dofs[index].clear();
    if (cell->is_artificial())
      continue;
    if (cell->is_locally_owned())
      owned.push_back(index);
    sizes[index] = cell->extent_in_direction(0);
    levels[index] = cell->level();
    boundary[index] = cell->at_boundary();
    cell->get_dof_indices(unordered);
    for (const unsigned int i : order)
      dofs[index].push_back(unordered[i]);
  }
  find_faces();
  find_corner();
}

template <int dim>
void UnfittedStokesSpace<dim>::find_faces()
{
  faces.clear();
  for (const auto &cell : handler.active_cell_iterators())
  {
    if (!cell->is_locally_owned())
      continue;
    for (const unsigned int face : cell->face_indices())
    {
      if (cell->at_boundary(face))
        continue;
      const auto neighbor = cell->neighbor(face);
      if (neighbor->has_children())
        continue; // from the fine side
      unsigned char refinement = 0;
      if (cell->neighbor_is_coarser(face))
      {
        // Bits of the position within the coarse face, the lower tangential direction first.
        unsigned int position = 0, bit = 0;
        for (unsigned int d = 0; d < dim; ++d)
          if (d != face / 2)
          {
            const double offset = cell->vertex(0)[d] - neighbor->vertex(0)[d];
            position += (offset > 0.5 * cell->extent_in_direction(0) ? 1u : 0u) << bit++;
          }
        refinement = static_cast<unsigned char>(1 + position);
      }
      else if (neighbor->is_locally_owned() ? face % 2 == 0 : neighbor->subdomain_id() < cell->subdomain_id())
        continue;
      faces.push_back({cell->active_cell_index(), neighbor->active_cell_index(),
                       static_cast<unsigned char>(face), refinement});
    }
  }
}

template <int dim>
void UnfittedStokesSpace<dim>::find_corner()
{
  // The point with the smallest sum of coordinates is the lower corner of the box, on whatever rank it lies.
  double smallest = std::numeric_limits<double>::max();
  for (const auto &cell : triangulation.cell_iterators_on_level(0))
  {
    double sum = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      sum += cell->vertex(0)[d];
    smallest = std::min(smallest, sum);
  }
  corner_pressure = numbers::invalid_dof_index;
  for (const auto &cell : handler.active_cell_iterators())
    if (!cell->is_artificial() && cell->at_boundary())
    {
      double sum = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        sum += cell->vertex(0)[d];
      if (sum < smallest + 1e-3 * cell->extent_in_direction(0))
        corner_pressure = dofs[cell->active_cell_index()][Layout::pressure(0)];
    }
}

template <int dim>
void UnfittedStokesSpace<dim>::constrain_hanging_nodes()
{
  // Of a face between a ghost cell and one that only other ranks know, this rank cannot see that it has
  // hanging nodes, and the ghost penalty uses all dofs of ghost cells. So the ranks exchange the constraints
  // of the dofs that they use, and then those of the masters, until all are known.
  IndexSet used;
  DoFTools::extract_locally_relevant_dofs(handler, used);
  for (bool is_complete = false; !is_complete;)
  {
    hanging_nodes.clear();
    hanging_nodes.reinit(used);
    DoFTools::make_hanging_node_constraints(handler, hanging_nodes);
    hanging_nodes.make_consistent_in_parallel(handler.locally_owned_dofs(), used, communicator());
    std::vector<types::global_dof_index> masters;
    for (const auto &line : hanging_nodes.get_lines())
      for (const auto &entry : line.entries)
        if (!used.is_element(entry.first))
          masters.push_back(entry.first);
    is_complete = Utilities::MPI::max(masters.empty() ? 0 : 1, communicator()) == 0;
    std::sort(masters.begin(), masters.end());
    masters.erase(std::unique(masters.begin(), masters.end()), masters.end());
    used.add_indices(masters.begin(), masters.end());
    used.compress();
  }
  hanging_nodes.close();
}

template <int dim>
void UnfittedStokesSpace<dim>::reinit(const CutGeometry<dim> &geometry,
                                      const Function<dim> &boundary_velocity)
{
  std::array<std::vector<bool>, 2> is_active;
  for (auto &flags : is_active)
    flags.assign(triangulation.n_active_cells(), false);
  bool touches_boundary = false;
  for (const unsigned int cell : owned)
  {
    for (unsigned int fluid = 0; fluid < 2; ++fluid)
      is_active[fluid][cell] = geometry.is_active(cell, fluid);
    touches_boundary = touches_boundary || (is_active[0][cell] && boundary[cell]);
  }
  if (Utilities::MPI::max(static_cast<int>(touches_boundary), communicator()))
    throw SimulationError(
        "The membrane has reached the boundary of the box, where the velocity is prescribed. "
        "Choose a larger box.");

  outside_constraints.clear();
  outside_constraints.reinit(hanging_nodes.get_local_lines());
  outside_constraints.merge(hanging_nodes);
  boundary_data.constrain(boundary_velocity, outside_constraints);
  outside_constraints.close();

  std::vector<unsigned int> part_of_component(dim, velocity_block);
  part_of_component.push_back(pressure_block);
  active[0].reinit(handler, hanging_nodes, is_active[0], part_of_component);
  active[1].reinit(handler, outside_constraints, is_active[1], part_of_component);
}

template <int dim>
void UnfittedStokesSpace<dim>::add_fields(BlockNumbering &numbering) const
{
  for (const auto &fluid : active)
    numbering.add_field(fluid.partition(), {velocity_block, pressure_block});
}

template <int dim>
void UnfittedStokesSpace<dim>::renumber(const BlockNumbering &numbering)
{
  for (unsigned int fluid = 0; fluid < 2; ++fluid)
    active[fluid].renumber(numbering, fluid);
}

template <int dim>
types::global_dof_index UnfittedStokesSpace<dim>::corner_unknown() const
{
  const auto here =
      corner_pressure == numbers::invalid_dof_index ? corner_pressure : active[1].number(corner_pressure);
  return Utilities::MPI::min(here, communicator());
}

template class UnfittedStokesSpace<2>;
template class UnfittedStokesSpace<3>;
} // namespace Gemmule
