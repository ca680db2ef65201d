// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/types.h>

#include <utility>
#include <vector>

namespace Gemmule
{
/**
 * How local degrees of freedom (of a cell, or of the two cells of a face) follow from the unknowns of a
 * reduced system: u_local = T x[indices] + g, T a permutation but for constrained (hanging) dofs. This is
 * what dealii::AffineConstraints knows of these dofs, looked up once for all matrices and vectors.
 */
struct CondensedIndices
{
  std::vector<dealii::types::global_dof_index> indices; ///< unknowns; after sort() ascending, each once
  std::vector<unsigned int> row_start{0}; ///< row i of T: entries [row_start[i], row_start[i+1])
  std::vector<std::pair<unsigned int, double>> entries; ///< (position in indices, weight)
  std::vector<double> inhomogeneities;                  ///< g

  unsigned int n_local() const { return row_start.size() - 1; }

  /** Sorts the unknowns and merges those that occur more than once. */
  void sort();

  /** Appends the local dofs of @p other, with number(index) for each of its unknowns; sort() must follow. */
  template <typename Number>
  void append(const CondensedIndices &other, const Number &number);
};

template <typename Number>
void CondensedIndices::append(const CondensedIndices &other, const Number &number)
{
  const unsigned int first_index = indices.size(), first_entry = entries.size();
  for (const auto index : other.indices)
    indices.push_back(number(index));
  for (const auto &[position, weight] : other.entries)
    entries.emplace_back(first_index + position, weight);
  for (unsigned int i = 0; i < other.n_local(); ++i)
  {
    row_start.push_back(first_entry + other.row_start[i + 1]);
    inhomogeneities.push_back(other.inhomogeneities[i]);
  }
}
} // namespace Gemmule
