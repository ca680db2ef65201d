// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/linear_system.h>
#include <gemmule/algebra/mumps_solver.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

LinearSystem::LinearSystem(const MPI_Comm communicator, const bool symmetric,
                           std::unique_ptr<LinearSolver> linear_solver)
    : communicator(communicator), blocks(communicator), sum(symmetric), solver(std::move(linear_solver))
{
  if (solver == nullptr)
    solver = std::make_unique<MumpsSolver>(communicator, symmetric);
}

void LinearSystem::begin(const BlockNumbering &numbering)
{
  elements_changed = partitioner == nullptr || !(numbering == blocks);
  blocks = numbering;
  n_used_elements = 0;
}

unsigned int LinearSystem::add_element(CondensedIndices &&element)
{
  Assert(std::is_sorted(element.indices.begin(), element.indices.end()),
         ExcMessage("CondensedIndices::sort() must be called before an element is added."));
  if (n_used_elements == elements.size())
  {
    elements.emplace_back();
    unknowns.emplace_back();
    elements_changed = true;
  }
  elements_changed = elements_changed || unknowns[n_used_elements] != element.indices;
  unknowns[n_used_elements] = element.indices;
  elements[n_used_elements] = std::move(element);
  return n_used_elements++;
}

void LinearSystem::finish_elements()
{
  elements_changed = elements_changed || n_used_elements != elements.size();
  elements.resize(n_used_elements);
  unknowns.resize(n_used_elements);
  // All ranks must agree, because what follows from the pattern is found together.
  const bool changed = Utilities::MPI::max(elements_changed ? 1u : 0u, communicator) > 0;
  localise(changed);
  if (changed)
    sum.reinit(partitioner, elements);
  elements_changed = false;
}

void LinearSystem::localise(const bool changed)
{
  const IndexSet owned = blocks.locally_owned();
  if (changed)
  {
    std::vector<types::global_dof_index> ghosts;
    for (const auto &element : elements)
      for (const auto index : element.indices)
        if (!owned.is_element(index))
          ghosts.push_back(index);
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
    IndexSet ghost_set(blocks.size());
    ghost_set.add_indices(ghosts.begin(), ghosts.end());
    ghost_set.compress();
    partitioner = std::make_shared<const Utilities::MPI::Partitioner>(owned, ghost_set, communicator);
  }
  for (auto &element : elements)
  {
    for (auto &index : element.indices)
      index = partitioner->global_to_local(index);
    // Ghosts come after the owned unknowns, whatever their numbers.
    if (!std::is_sorted(element.indices.begin(), element.indices.end()))
      element.sort();
  }
}

void LinearSystem::add_inhomogeneity(const unsigned int e, const FullMatrix<double> &local,
                                     Vector &right_side, const double factor) const
{
  const CondensedIndices &element = elements[e];
  const auto &g = element.inhomogeneities;
  if (std::all_of(g.begin(), g.end(), [](const double value) { return value == 0.; }))
    return;
  std::vector<double> product(element.n_local(), 0.);
  for (unsigned int i = 0; i < element.n_local(); ++i)
    for (unsigned int j = 0; j < element.n_local(); ++j)
      product[i] -= factor * local(i, j) * g[j];
  add_right_side(e, product.data(), right_side);
}

void LinearSystem::add_right_side(const unsigned int e, const double *const local, Vector &right_side) const
{
  Assert(right_side.get_partitioner() == partitioner, ExcMessage("The vector is one of an earlier pattern."));
  const CondensedIndices &element = elements[e];
  double *const values = right_side.get_values();
  for (unsigned int i = 0; i < element.n_local(); ++i)
    for (unsigned int k = element.row_start[i]; k < element.row_start[i + 1]; ++k)
      values[element.indices[element.entries[k].first]] += element.entries[k].second * local[i];
}

void LinearSystem::gather(const unsigned int e, const Vector &solution, double *const local,
                          const bool homogeneous) const
{
  Assert(solution.get_partitioner()->is_compatible(*partitioner),
         ExcMessage("The vector is one of an earlier pattern."));
  const CondensedIndices &element = elements[e];
  const double *const values = solution.get_values();
  for (unsigned int i = 0; i < element.n_local(); ++i)
  {
    double value = homogeneous ? 0. : element.inhomogeneities[i];
    for (unsigned int k = element.row_start[i]; k < element.row_start[i + 1]; ++k)
      value += element.entries[k].second * values[element.indices[element.entries[k].first]];
    local[i] = value;
  }
}

void LinearSystem::solve(std::vector<Vector> &right_sides, std::vector<Vector> &solutions)
{
  AssertDimension(right_sides.size(), solutions.size());
  for (auto &right_side : right_sides)
    right_side.compress(VectorOperation::add);
  for (auto &solution : solutions)
    solution.zero_out_ghost_values();
  solver->solve(right_sides, solutions);
  for (auto &solution : solutions)
    solution.update_ghost_values();
}

LinearSystem::Vector LinearSystem::solve(Vector right_side)
{
  std::vector<Vector> right_sides, solutions;
  right_sides.push_back(std::move(right_side));
  solutions.push_back(make_vector());
  solve(right_sides, solutions);
  Vector solution;
  solution.swap(solutions[0]); // a copy would not have the ghosts
  return solution;
}

LinearSystem::Vector LinearSystem::vmult(const Vector &x) const
{
  Vector product = make_vector();
  sum.vmult_add(product.get_values(), x.get_values());
  product.compress(VectorOperation::add);
  return product;
}
} // namespace Gemmule
