// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/subassembled_matrix.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

void SubassembledMatrix::reinit(const std::shared_ptr<const Utilities::MPI::Partitioner> &partitioner,
                                const std::vector<CondensedIndices> &elements)
{
  layout = partitioner;
  ++version;
  const unsigned int n = layout->locally_owned_size() + layout->n_ghost_indices();

  // rows -> elements, then the union of the elements' unknowns row by row
  std::vector<std::size_t> start(n + 1, 0);
  for (const auto &element : elements)
    for (const auto index : element.indices)
      ++start[index + 1];
  for (unsigned int row = 0; row < n; ++row)
    start[row + 1] += start[row];
  std::vector<unsigned int> elements_of_row(start[n]);
  std::vector<std::size_t> fill(start.begin(), start.end() - 1);
  for (unsigned int e = 0; e < elements.size(); ++e)
    for (const auto index : elements[e].indices)
      elements_of_row[fill[index]++] = e;

  row_start.assign(n + 1, 0);
  columns.clear();
  std::vector<unsigned int> last_seen(n, numbers::invalid_unsigned_int);
  for (unsigned int row = 0; row < n; ++row)
  {
    const std::size_t begin_of_row = columns.size();
    for (std::size_t k = start[row]; k < start[row + 1]; ++k)
      for (const auto column : elements[elements_of_row[k]].indices)
        if ((!symmetric || column >= row) && last_seen[column] != row)
        {
          last_seen[column] = row;
          columns.push_back(column);
        }
    std::sort(columns.begin() + begin_of_row, columns.end());
    row_start[row + 1] = columns.size();
  }
  values.assign(columns.size(), 0.);
}

void SubassembledMatrix::set_zero()
{
  std::fill(values.begin(), values.end(), 0.);
}

void SubassembledMatrix::add(const CondensedIndices &element, const FullMatrix<double> &local)
{
  const unsigned int n_local = element.n_local(), n_reduced = element.indices.size();
  AssertDimension(local.m(), n_local);
  condensed.reinit(n_reduced, n_reduced);
  for (unsigned int i = 0; i < n_local; ++i)
    for (unsigned int k = element.row_start[i]; k < element.row_start[i + 1]; ++k)
    {
      const double row_weight = element.entries[k].second;
      double *const row = &condensed(element.entries[k].first, 0);
      const double *const source = &local(i, 0);
      for (unsigned int j = 0; j < n_local; ++j)
        for (unsigned int l = element.row_start[j]; l < element.row_start[j + 1]; ++l)
          row[element.entries[l].first] += row_weight * element.entries[l].second * source[j];
    }
  for (unsigned int i = 0; i < n_reduced; ++i)
  {
    std::size_t position = row_start[element.indices[i]];
    for (unsigned int j = symmetric ? i : 0; j < n_reduced; ++j)
    {
      while (columns[position] != element.indices[j])
        ++position;
      values[position] += condensed(i, j);
    }
  }
}

void SubassembledMatrix::vmult_add(double *const destination, const double *const source) const
{
  for (unsigned int row = 0; row < n_rows(); ++row)
    for (std::size_t k = row_start[row]; k < row_start[row + 1]; ++k)
    {
      destination[row] += values[k] * source[columns[k]];
      if (symmetric && columns[k] != row)
        destination[columns[k]] += values[k] * source[row];
    }
}
} // namespace Gemmule
