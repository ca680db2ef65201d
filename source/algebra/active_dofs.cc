// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/active_dofs.h>

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>

#include <algorithm>
#include <numeric>

namespace Gemmule
{
using namespace dealii;

void CondensedIndices::gather(const std::vector<double> &solution, double *local,
                              const bool homogeneous) const
{
  for (unsigned int i = 0; i < n_local(); ++i)
  {
    double value = homogeneous ? 0. : inhomogeneities[i];
    for (unsigned int k = row_start[i]; k < row_start[i + 1]; ++k)
      value += entries[k].second * solution[indices[entries[k].first]];
    local[i] = value;
  }
}

void CondensedIndices::scatter(const double *local, std::vector<double> &residual) const
{
  for (unsigned int i = 0; i < n_local(); ++i)
    for (unsigned int k = row_start[i]; k < row_start[i + 1]; ++k)
      residual[indices[entries[k].first]] += entries[k].second * local[i];
}

template <int dim>
void ActiveDofs<dim>::reinit(const DoFHandler<dim> &dof_handler,
                             const AffineConstraints<double> &constraints_,
                             const std::vector<bool> &cell_is_active, const unsigned int first_number)
{
  constraints = &constraints_;
  first = first_number;
  const MPI_Comm communicator = dof_handler.get_communicator();
  const IndexSet &owned = dof_handler.locally_owned_dofs();
  IndexSet relevant;
  DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
  // A constraint of a relevant dof may lead to a master beyond the ghost layer.
  IndexSet reach = relevant;
  std::vector<types::global_dof_index> masters;
  for (const auto &line : constraints->get_lines())
    for (const auto &entry : line.entries)
      masters.push_back(entry.first);
  std::sort(masters.begin(), masters.end());
  masters.erase(std::unique(masters.begin(), masters.end()), masters.end());
  reach.add_indices(masters.begin(), masters.end());
  reach.compress();

  // Counts instead of flags: compress(add) sums the marks of the ranks, anything positive is active.
  Vector marks(owned, reach, communicator);
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

  bool grown = true;
  while (grown)
  {
    Vector additions(owned, reach, communicator);
    unsigned int n_additions = 0;
    for (const auto &line : constraints->get_lines())
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

  unsigned int n_mine = 0;
  for (const auto dof : owned)
    if (marks(dof) > 0. && !constraints->is_constrained(dof))
      ++n_mine;
  unsigned int offset = 0;
  MPI_Exscan(&n_mine, &offset, 1, MPI_UNSIGNED, MPI_SUM, communicator);
  if (Utilities::MPI::this_mpi_process(communicator) == 0)
    offset = 0;
  n_unknowns = Utilities::MPI::sum(n_mine, communicator);

  numbers.reinit(owned, reach, communicator);
  unsigned int next = first + offset;
  for (const auto dof : owned)
    numbers(dof) = marks(dof) > 0. && !constraints->is_constrained(dof) ? static_cast<double>(next++) : -1.;
  numbers.update_ghost_values();
  active.swap(marks);
}

template <int dim>
void ActiveDofs<dim>::append(const std::vector<types::global_dof_index> &dofs,
                             CondensedIndices &element) const
{
  const auto add_entry = [&](const types::global_dof_index dof, const double weight)
  {
    const int number_of_dof = number(dof);
    AssertThrow(number_of_dof >= 0, ExcMessage("An element uses a dof that is not active."));
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
void ActiveDofs<dim>::finish(CondensedIndices &element)
{
  std::vector<unsigned int> unique = element.indices;
  std::sort(unique.begin(), unique.end());
  unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
  for (auto &entry : element.entries)
    entry.first =
        std::lower_bound(unique.begin(), unique.end(), element.indices[entry.first]) - unique.begin();
  element.indices.swap(unique);
}

template class ActiveDofs<2>;
template class ActiveDofs<3>;
} // namespace Gemmule
