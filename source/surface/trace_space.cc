// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_snapshot.h>
#include <gemmule/surface/trace_space.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>

#include <algorithm>
#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
TraceSpace<dim>::TraceSpace(const Triangulation<dim> &triangulation)
    : triangulation(triangulation), fe(2), dof_handler(triangulation),
      lexicographic(lexicographic_cell_dofs(fe))
{
}

template <int dim>
void TraceSpace<dim>::reinit_mesh()
{
  dof_handler.distribute_dofs(fe);
  IndexSet relevant;
  DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
  constraints.reinit(relevant);
  DoFTools::make_hanging_node_constraints(dof_handler, constraints);
  constraints.close();
  locator.reinit(triangulation);
  owned_cells.assign(triangulation.n_active_cells(), {});
  for (const auto &cell : dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      owned_cells[cell->active_cell_index()] = cell;
  current_geometry = nullptr;
  cells.clear();
  cell_elements.clear();
}

template <int dim>
void TraceSpace<dim>::locate_clouds(const Interface<dim> &interface,
                                    const std::array<const MembraneCloud<dim> *, 2> &clouds,
                                    std::vector<bool> &is_in_active_mesh)
{
  located.clear();
  std::size_t n_points = 0;
  for (const auto *cloud : clouds)
    n_points += cloud ? cloud->points.size() : 0;
  if (n_points == 0)
    return;

  // Distance of each earlier point from the membrane of now; the last entry counts the points that were
  // found.
  std::vector<double> distance(n_points + 1, 0.);
  std::array<double, TensorLagrange<dim, 3>::n> nodal{};
  unsigned int nodal_of = numbers::invalid_unsigned_int;
  std::size_t k = 0;
  for (unsigned int c = 0; c < clouds.size(); ++c)
    if (clouds[c])
      for (unsigned int i = 0; i < clouds[c]->points.size(); ++i, ++k)
        if (const auto *cell = locator.find(clouds[c]->points[i]))
        {
          const auto unit = cell->unit(clouds[c]->points[i]);
          if (nodal_of != cell->active_cell_index)
          {
            nodal_of = cell->active_cell_index;
            nodal = interface.level_set().values_on(owned_cells[nodal_of]).level_set;
          }
          distance[k] = TensorLagrange<dim, 3>::value(nodal, unit);
          distance.back() += 1.;
          is_in_active_mesh[cell->active_cell_index] = true;
          located.push_back({cell->active_cell_index, c, {i, unit}});
        }
  Utilities::MPI::sum(ArrayView<const double>(distance), communicator(), ArrayView<double>(distance));
  if (distance.back() != static_cast<double>(n_points))
    throw SimulationError(
        "The membrane reaches out of the box; enlarge section \"Domain\" or end the run earlier.");

  // Cells between an earlier point and the membrane of now, on whichever rank they are: without them a
  // membrane that moves by more than a cell would leave parts of the active mesh unconnected, and the system
  // singular.
  k = 0;
  for (const auto *cloud : clouds)
    if (cloud)
      for (unsigned int i = 0; i < cloud->points.size(); ++i, ++k)
      {
        const unsigned int n_samples = std::ceil(2. * std::abs(distance[k]) / locator.smallest_size());
        for (unsigned int s = 1; s < n_samples; ++s)
          if (const auto *cell =
                  locator.find(cloud->points[i] - (s * distance[k] / n_samples) * cloud->normals[i]))
            is_in_active_mesh[cell->active_cell_index] = true;
      }
}

template <int dim>
void TraceSpace<dim>::compute_normal_derivatives(
    TraceCell<dim> &cell, const std::array<double, TensorLagrange<dim, 3>::n> &level_set) const
{
  static const QGauss<dim> quadrature(3);
  constexpr unsigned int n = Basis::n;
  cell.normal_derivatives.reinit(n, n);
  const double scale = std::pow(cell.size, dim - 2); // h^dim of the volume, 1/h of each derivative

  typename Basis::Values values;
  typename Basis::Gradients gradients;
  typename TensorLagrange<dim, 3>::Values level_set_values;
  typename TensorLagrange<dim, 3>::Gradients level_set_gradients;
  std::array<double, n> derivative;
  for (unsigned int q = 0; q < quadrature.size(); ++q)
  {
    Basis::evaluate(quadrature.point(q), values, gradients);
    TensorLagrange<dim, 3>::evaluate(quadrature.point(q), level_set_values, level_set_gradients);
    Tensor<1, dim> normal;
    for (unsigned int i = 0; i < level_set.size(); ++i)
      normal += level_set[i] * level_set_gradients[i];
    normal /= std::max(normal.norm(), 1e-300);
    for (unsigned int i = 0; i < n; ++i)
      derivative[i] = normal * gradients[i];
    for (unsigned int i = 0; i < n; ++i)
    {
      const double factor = quadrature.weight(q) * scale * derivative[i];
      for (unsigned int j = 0; j < n; ++j)
        cell.normal_derivatives(i, j) += factor * derivative[j];
    }
  }
}

template <int dim>
void TraceSpace<dim>::prepare(const Interface<dim> &interface,
                              const std::array<const MembraneCloud<dim> *, 2> &clouds)
{
  AssertDimension(owned_cells.size(), triangulation.n_active_cells());
  const CutGeometry<dim> &geometry = interface.geometry();
  current_geometry = &geometry;
  std::vector<bool> is_in_active_mesh(triangulation.n_active_cells(), false);
  for (const auto &cut : geometry.cut_cells())
    is_in_active_mesh[cut.active_cell_index] = true;
  locate_clouds(interface, clouds, is_in_active_mesh);
  active_dofs.reinit(dof_handler, constraints, is_in_active_mesh);

  cells.clear();
  cell_elements.clear();
  std::vector<unsigned int> trace_cell_of(is_in_active_mesh.size(), numbers::invalid_unsigned_int);
  std::vector<types::global_dof_index> dofs(Basis::n), ordered(Basis::n);
  for (unsigned int index = 0; index < is_in_active_mesh.size(); ++index)
    if (is_in_active_mesh[index])
    {
      const auto &cell = owned_cells[index];
      TraceCell<dim> trace_cell;
      trace_cell.active_cell_index = index;
      trace_cell.corner = cell->vertex(0);
      trace_cell.size = cell->extent_in_direction(0);
      trace_cell.cut = geometry.find(index);
      if (trace_cell.cut)
        trace_cell.cut_index = trace_cell.cut - geometry.cut_cells().data();
      compute_normal_derivatives(trace_cell, interface.level_set().values_on(cell).level_set);
      trace_cell_of[index] = cells.size();
      cells.push_back(std::move(trace_cell));

      cell->get_dof_indices(dofs);
      for (unsigned int i = 0; i < Basis::n; ++i)
        ordered[i] = dofs[lexicographic[i]];
      CondensedIndices element;
      active_dofs.append(ordered, element);
      element.sort();
      cell_elements.push_back(std::move(element));
    }
  for (const auto &entry : located)
    cells[trace_cell_of[entry.active_cell_index]].cloud_points[entry.cloud].push_back(entry.point);
}

template <int dim>
TraceField<dim> TraceSpace<dim>::extract(const LinearSystem &system, const LinearSystem::Vector &solution,
                                         const unsigned int field) const
{
  TraceField<dim> values(current_geometry->cut_cells().size());
  std::vector<double> local;
  for (unsigned int k = 0; k < cells.size(); ++k)
    if (cells[k].cut)
    {
      local.resize(system.numbering().n_fields() * Basis::n);
      system.gather(k, solution, local.data());
      std::copy_n(local.begin() + field * Basis::n, Basis::n, values[cells[k].cut_index].begin());
    }
  return values;
}

template class TraceSpace<2>;
template class TraceSpace<3>;
} // namespace Gemmule
