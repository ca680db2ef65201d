// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/gather.h>
#include <gemmule/geometry/level_set.h>

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/numerics/vector_tools_interpolate.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // Cells within this many of their own sizes of the membrane get exact distances: those that the membrane
  // cuts now or can reach within a step, and their neighbours.
  constexpr double half_width_in_cells = 2.5;

  // A cell whose centre is farther away than this will not be cut after a step.
  constexpr double reach_in_cells = 1.6;

  // Halved with each level: 5e-11 of the finest cells.
  constexpr double tiny_part_of_coarse_cell = 5e-11;

  /** Is the cell beside a larger one that the membrane may cut after the step? It belongs to the narrow band
   * then, however far that is in terms of its own size. */
  template <int dim, typename CellIterator>
  bool is_beside_larger_cut_cell(const CellIterator &cell, const MembraneProjection<dim> &membrane)
  {
    for (const unsigned int face : cell->face_indices())
      if (!cell->at_boundary(face) && cell->neighbor_is_coarser(face))
      {
        const auto neighbor = cell->neighbor(face);
        const Point<dim> center = neighbor->center();
        if (center.distance(membrane.nearest(center).point) <
            reach_in_cells * neighbor->extent_in_direction(0))
          return true;
      }
    return false;
  }
} // namespace

template <int dim>
LevelSet<dim>::LevelSet(const parallel::distributed::Triangulation<dim> &triangulation)
    : triangulation(triangulation), fe(3), dof_handler(triangulation),
      node_to_dof(lexicographic_cell_dofs(static_cast<const FiniteElement<dim> &>(fe))),
      filter(dof_handler, node_to_dof)
{
}

template <int dim>
void LevelSet<dim>::reinit_mesh()
{
  dof_handler.distribute_dofs(fe);
  IndexSet relevant;
  DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
  constraints.reinit(relevant);
  DoFTools::make_hanging_node_constraints(dof_handler, constraints);
  constraints.close();
  phi.reinit(dof_handler.locally_owned_dofs(), relevant, triangulation.get_communicator());
  far_nodes_are_set = false;
  is_in_narrow_band.clear();
}

template <int dim>
void LevelSet<dim>::finish()
{
  // The rules of the cut cells dislike zeros at nodes: move them off by far less than the discretisation
  // error.
  const double coarse_size = triangulation.begin(0)->extent_in_direction(0);
  const double tiny = tiny_part_of_coarse_cell * coarse_size * std::pow(0.5, triangulation.n_global_levels());
  phi.update_ghost_values();
  constraints.distribute(phi);
  for (unsigned int i = 0; i < phi.locally_owned_size(); ++i)
    if (std::abs(phi.local_element(i)) < tiny)
      phi.local_element(i) = tiny;
  phi.update_ghost_values();
}

template <int dim>
void LevelSet<dim>::interpolate(const Function<dim> &function)
{
  phi.zero_out_ghost_values();
  VectorTools::interpolate(dof_handler, function, phi);
  finish();
}

template <int dim>
void LevelSet<dim>::set_nodes(const MembraneProjection<dim> &membrane,
                              const std::function<double(const Point<dim> &)> &accurate,
                              const NarrowBandLevelSet<dim> *const sides, const double least_width)
{
  const IndexSet &owned = dof_handler.locally_owned_dofs();
  // Node by node: 2 exact, 1 approximate, 0 not yet. A node takes the better of what its cells ask for.
  std::vector<unsigned char> state(owned.n_elements(), 0);
  std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
  phi.zero_out_ghost_values();
  is_in_narrow_band.assign(triangulation.n_active_cells(), false);
  for (const auto &cell : dof_handler.active_cell_iterators())
  {
    if (!cell->is_locally_owned() && !cell->is_ghost())
      continue;
    const double h = cell->extent_in_direction(0);
    const Point<dim> center = cell->center();
    const auto &nearest = membrane.nearest(center);
    const double distance = center.distance(nearest.point);
    const bool in_narrow_band =
        distance < std::max(half_width_in_cells * h, least_width) ||
        (distance < 2. * half_width_in_cells * h && is_beside_larger_cut_cell<dim>(cell, membrane));
    is_in_narrow_band[cell->active_cell_index()] = in_narrow_band;
    if (!in_narrow_band && far_nodes_are_set)
      continue;
    // Beyond the narrow band all of a cell is on one side, and its distance from one point of the membrane
    // will do.
    double side = 0.;
    if (!in_narrow_band)
    {
      const double signed_distance = membrane.approximate_distance(center);
      side = sides == nullptr ? signed_distance : sides->with_side(signed_distance, center);
    }
    cell->get_dof_indices(dofs);
    for (unsigned int i = 0; i < node_to_dof.size(); ++i)
    {
      const auto dof = dofs[node_to_dof[i]];
      if (!owned.is_element(dof))
        continue;
      unsigned char &done = state[owned.index_within_set(dof)];
      if (done == 2 || (done == 1 && !in_narrow_band))
        continue;
      const Point<dim> x = cell->vertex(0) + h * Tensor<1, dim>(TensorLagrange<dim, 3>::node(i));
      phi(dof) = in_narrow_band ? accurate(x) : std::copysign(x.distance(nearest.point), side);
      done = in_narrow_band ? 2 : 1;
    }
  }
  far_nodes_are_set = true;
  finish();
}

template <int dim>
void LevelSet<dim>::set_distance(const MembraneProjection<dim> &membrane,
                                 const std::function<double(const ClosestPoint<dim> &)> &offset)
{
  set_nodes(
      membrane,
      [&](const Point<dim> &x)
      {
        const ClosestPoint<dim> closest = membrane.project(x);
        return offset ? closest.distance - offset(closest) : closest.distance;
      },
      nullptr);
}

template <int dim>
void LevelSet<dim>::set_distance(const MembraneProjection<dim> &membrane,
                                 const NarrowBandLevelSet<dim> &sides, const double width)
{
  forget_far_nodes();
  set_nodes(
      membrane, [&](const Point<dim> &x) { return sides.with_side(membrane.project(x).distance, x); }, &sides,
      width);
}

template <int dim>
void LevelSet<dim>::advance(const MembraneMotion<dim> &motion, const NarrowBandLevelSet<dim> &old_level_set,
                            const bool redistance)
{
  set_nodes(
      motion.old_membrane(),
      [&](const Point<dim> &x)
      {
        const auto trajectory = motion.trace_back(x);
        const Point<dim> old_x = x - trajectory.displacement;
        if (!redistance)
          if (const auto value = old_level_set.value(old_x))
            return *value;
        return old_level_set.with_side(trajectory.departure_point.distance, old_x);
      },
      &old_level_set);
  filter.sweep(phi, is_in_narrow_band);
  finish();
}

template <int dim>
LevelSetCell<dim>
LevelSet<dim>::values_on(const typename Triangulation<dim>::active_cell_iterator &cell) const
{
  std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
  typename DoFHandler<dim>::active_cell_iterator(&triangulation, cell->level(), cell->index(), &dof_handler)
      ->get_dof_indices(dofs);
  LevelSetCell<dim> result;
  result.corner = cell->vertex(0);
  result.size = cell->extent_in_direction(0);
  for (unsigned int i = 0; i < node_to_dof.size(); ++i)
    result.level_set[i] = phi(dofs[node_to_dof[i]]);
  return result;
}

template <int dim>
std::vector<LevelSetCell<dim>> LevelSet<dim>::gather_narrow_band() const
{
  std::vector<LevelSetCell<dim>> local;
  for (const auto &cell : dof_handler.active_cell_iterators())
    if (!is_in_narrow_band.empty() && cell->is_locally_owned() &&
        is_in_narrow_band[cell->active_cell_index()])
      local.push_back(values_on(cell));
  return gather_plain(local, triangulation.get_communicator());
}

template <int dim>
std::vector<LevelSetCell<dim>> LevelSet<dim>::gather_cells() const
{
  std::vector<LevelSetCell<dim>> local;
  for (const auto &cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      local.push_back(values_on(cell));
  return gather_plain(local, triangulation.get_communicator());
}

template <int dim>
void LevelSet<dim>::restore(const std::vector<LevelSetCell<dim>> &cells, const bool set_everywhere)
{
  Point<dim> origin;
  for (unsigned int d = 0; d < dim; ++d)
    origin[d] = std::numeric_limits<double>::max();
  for (const auto &cell : cells)
    for (unsigned int d = 0; d < dim; ++d)
      origin[d] = std::min(origin[d], cell.corner[d]);
  CartesianCellMap<dim> map(origin);
  for (unsigned int c = 0; c < cells.size(); ++c)
    map.insert(cells[c].corner, cells[c].size, c);

  const IndexSet &owned = dof_handler.locally_owned_dofs();
  std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
  phi.zero_out_ghost_values();
  for (const auto &cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      const int c = map.find(cell->center());
      AssertThrow(c >= 0, ExcMessage("The level set must be given on all cells of the mesh."));
      cell->get_dof_indices(dofs);
      for (unsigned int i = 0; i < node_to_dof.size(); ++i)
        if (owned.is_element(dofs[node_to_dof[i]]))
          phi(dofs[node_to_dof[i]]) = cells[c].level_set[i];
    }
  // They were finished when they were taken; finishing them again might change the last digit.
  phi.update_ghost_values();
  far_nodes_are_set = set_everywhere;
}

template <int dim>
bool LevelSet<dim>::is_accurate_around(const CutGeometry<dim> &geometry) const
{
  const auto &cut_cells = geometry.cut_cells();
  const bool is_accurate =
      !is_in_narrow_band.empty() &&
      std::all_of(cut_cells.begin(), cut_cells.end(),
                  [&](const auto &cell) { return is_in_narrow_band[cell.active_cell_index]; });
  return Utilities::MPI::min(static_cast<unsigned int>(is_accurate), triangulation.get_communicator()) > 0;
}

template <int dim>
void LevelSet<dim>::shift(const double amount)
{
  // Not the other nodes: they are not set anew in each step, so that shifts would add up there, also those of
  // rejected steps, until a sign changes.
  const IndexSet &owned = dof_handler.locally_owned_dofs();
  std::vector<bool> shifted(owned.n_elements(), is_in_narrow_band.empty());
  std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
  for (const auto &cell : dof_handler.active_cell_iterators())
    if (!is_in_narrow_band.empty() && !cell->is_artificial() && is_in_narrow_band[cell->active_cell_index()])
    {
      cell->get_dof_indices(dofs);
      for (const auto dof : dofs)
        if (owned.is_element(dof))
          shifted[owned.index_within_set(dof)] = true;
    }
  phi.zero_out_ghost_values();
  for (unsigned int i = 0; i < phi.locally_owned_size(); ++i)
    if (shifted[i])
      phi.local_element(i) += amount;
  finish();
}

template class LevelSet<2>;
template class LevelSet<3>;
} // namespace Gemmule
