// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/active_dofs.h>

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

namespace
{
  using Marks = LinearAlgebra::distributed::Vector<double>;

  /** The dofs that this rank may meet: relevant ones, and masters beyond the ghost layer. */
  template <int dim>
  IndexSet reachable_dofs(const DoFHandler<dim> &dof_handler, const AffineConstraints<double> &constraints)
  {
    IndexSet reach;
    DoFTools::extract_locally_relevant_dofs(dof_handler, reach);
    std::vector<types::global_dof_index> masters;
    for (const auto &line : constraints.get_lines())
      for (const auto &entry : line.entries)
        masters.push_back(entry.first);
    std::sort(masters.begin(), masters.end());
    masters.erase(std::unique(masters.begin(), masters.end()), masters.end());
    reach.add_indices(masters.begin(), masters.end());
    reach.compress();
    return reach;
  }

  /** Counts instead of flags: compress(add) sums the marks of the ranks, anything positive is active. */
  template <int dim>
  Marks mark_active_dofs(const DoFHandler<dim> &dof_handler, const AffineConstraints<double> &constraints,
                         const std::vector<bool> &cell_is_active)
  {
    Marks marks(dof_handler.locally_owned_dofs(), reachable_dofs(dof_handler, constraints),
                dof_handler.get_communicator());
    std::vector<types::global_dof_index> dofs(dof_handler.get_fe().n_dofs_per_cell());
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned() && cell_is_active[cell->active_cell_index()])
      {
        cell->get_dof_indices(dofs);
        for (const auto dof : dofs)
          marks(dof) = 1.;
      }
    marks.compress(VectorOperation::add);
    marks.update_ghost_values();
    return marks;
  }

  /** Adds the masters of constrained dofs, and theirs. */
  void close_under_constraints(const AffineConstraints<double> &constraints, Marks &marks)
  {
    const MPI_Comm communicator = marks.get_mpi_communicator();
    for (bool grown = true; grown;)
    {
      Marks additions(marks.get_partitioner());
      unsigned int n_additions = 0;
      for (const auto &line : constraints.get_lines())
        if (marks(line.index) > 0.)
          for (const auto &entry : line.entries)
            if (marks(entry.first) == 0.)
            {
              additions(entry.first) = 1.;
              ++n_additions;
            }
      grown = Utilities::MPI::max(n_additions, communicator) > 0;
      if (grown)
      {
        additions.compress(VectorOperation::add);
        marks.zero_out_ghost_values();
        marks += additions;
        marks.update_ghost_values();
      }
    }
  }

  /** By owned dof, in their order. */
  template <int dim>
  std::vector<unsigned int> parts_of_owned_dofs(const DoFHandler<dim> &dof_handler,
                                                const std::vector<unsigned int> &part_of_component)
  {
    const IndexSet &owned = dof_handler.locally_owned_dofs();
    std::vector<unsigned int> parts(owned.n_elements(), 0);
    if (part_of_component.empty())
      return parts;
    for (unsigned int c = 0; c < part_of_component.size(); ++c)
      if (part_of_component[c] > 0)
      {
        ComponentMask mask(part_of_component.size(), false);
        mask.set(c, true);
        for (const auto dof : DoFTools::extract_dofs(dof_handler, mask))
          parts[owned.index_within_set(dof)] = part_of_component[c];
      }
    return parts;
  }
} // namespace

template <int dim>
void ActiveDofs<dim>::reinit(const DoFHandler<dim> &dof_handler,
                             const AffineConstraints<double> &constraints_,
                             const std::vector<bool> &cell_is_active,
                             const std::vector<unsigned int> &part_of_component)
{
  constraints = &constraints_;
  Marks marks = mark_active_dofs(dof_handler, *constraints, cell_is_active);
  close_under_constraints(*constraints, marks);
  layout = marks.get_partitioner();

  const auto parts = parts_of_owned_dofs(dof_handler, part_of_component);
  const IndexSet &owned = dof_handler.locally_owned_dofs();
  std::vector<bool> is_unknown(parts.size());
  std::vector<Index> n_owned(part_of_component.empty()
                                 ? 1
                                 : 1 + *std::max_element(part_of_component.begin(), part_of_component.end()),
                             0);
  for (unsigned int i = 0; i < parts.size(); ++i)
  {
    is_unknown[i] = marks.local_element(i) > 0. && !constraints->is_constrained(owned.nth_index_in_set(i));
    if (is_unknown[i])
      ++n_owned[parts[i]];
  }
  unknowns = UnknownPartition(n_owned, dof_handler.get_communicator());

  const unsigned int rank = Utilities::MPI::this_mpi_process(dof_handler.get_communicator());
  std::vector<Index> next;
  for (unsigned int part = 0; part < n_owned.size(); ++part)
    next.push_back(unknowns.first(rank, part));
  numbers.assign(parts.size() + layout->n_ghost_indices(), dealii::numbers::invalid_dof_index);
  for (unsigned int i = 0; i < parts.size(); ++i)
    if (is_unknown[i])
      numbers[i] = next[parts[i]]++;

  std::vector<Index> to_send(layout->n_import_indices());
  std::vector<MPI_Request> requests;
  const ArrayView<Index> ghosts(numbers.data() + parts.size(), layout->n_ghost_indices());
  layout->export_to_ghosted_array_start<Index, MemorySpace::Host>(
      0, ArrayView<const Index>(numbers.data(), parts.size()),
      ArrayView<Index>(to_send.data(), to_send.size()), ghosts, requests);
  layout->export_to_ghosted_array_finish<Index, MemorySpace::Host>(ghosts, requests);
}

template <int dim>
void ActiveDofs<dim>::renumber(const BlockNumbering &numbering, const unsigned int field)
{
  for (auto &number : numbers)
    if (number != dealii::numbers::invalid_dof_index)
      number = numbering.number(field, number);
}

template <int dim>
void ActiveDofs<dim>::append(const std::vector<types::global_dof_index> &dofs,
                             CondensedIndices &element) const
{
  element.indices.reserve(element.indices.size() + dofs.size());
  element.entries.reserve(element.entries.size() + dofs.size());
  element.row_start.reserve(element.row_start.size() + dofs.size());
  element.inhomogeneities.reserve(element.inhomogeneities.size() + dofs.size());
  const auto add_entry = [&](const types::global_dof_index dof, const double weight)
  {
    const Index number_of_dof = number(dof);
    AssertThrow(number_of_dof != dealii::numbers::invalid_dof_index,
                ExcMessage("An element uses a dof that is not active."));
    element.entries.emplace_back(element.indices.size(), weight);
    element.indices.push_back(number_of_dof);
  };
  for (const auto dof : dofs)
  {
    double inhomogeneity = 0.;
    if (!constraints->is_constrained(dof))
      add_entry(dof, 1.);
    else
    {
      if (const auto *entries = constraints->get_constraint_entries(dof))
        for (const auto &entry : *entries)
          add_entry(entry.first, entry.second);
      inhomogeneity = constraints->get_inhomogeneity(dof);
    }
    element.row_start.push_back(element.entries.size());
    element.inhomogeneities.push_back(inhomogeneity);
  }
}

template <int dim>
void ActiveDofs<dim>::copy_to_dofs(const LinearAlgebra::distributed::Vector<double> &solution,
                                   std::vector<double> &by_dof) const
{
  by_dof.assign(layout->locally_owned_size(), 0.);
  for (unsigned int i = 0; i < by_dof.size(); ++i)
    if (numbers[i] != dealii::numbers::invalid_dof_index)
      by_dof[i] = solution(numbers[i]);
}

template <int dim>
void ActiveDofs<dim>::copy_from_dofs(const std::vector<double> &by_dof,
                                     LinearAlgebra::distributed::Vector<double> &solution) const
{
  AssertDimension(by_dof.size(), layout->locally_owned_size());
  for (unsigned int i = 0; i < by_dof.size(); ++i)
    if (numbers[i] != dealii::numbers::invalid_dof_index)
      solution(numbers[i]) = by_dof[i];
}

template class ActiveDofs<2>;
template class ActiveDofs<3>;
} // namespace Gemmule
