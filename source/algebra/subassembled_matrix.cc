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
  pattern.reinit(n, elements, symmetric);
  entry_of_column.resize(n);
  values.assign(pattern.n_entries(), 0.);
  is_zero = true;
}

void SubassembledMatrix::set_zero()
{
  if (!is_zero)
    std::fill(values.begin(), values.end(), 0.);
  is_zero = true;
}

void SubassembledMatrix::find_runs(const CondensedIndices &element)
{
  runs.clear();
  const auto &indices = element.indices;
  for (unsigned int i = 0; i < indices.size(); ++i)
    if (i > 0 && indices[i] == indices[i - 1] + 1)
      ++runs.back().end;
    else
      runs.push_back({i, i + 1, 0});
}

void SubassembledMatrix::map_row(const unsigned int row)
{
  const std::size_t begin = row_begin(row), end = row_begin(row + 1);
  for (std::size_t k = begin; k < end; ++k)
    entry_of_column[column(k)] = k - begin;
}

void SubassembledMatrix::add(const CondensedIndices &element, const FullMatrix<double> &local,
                             const double factor)
{
  AssertDimension(local.m(), element.n_local());
  is_zero = false;
  condensation.reinit(element);
  find_runs(element);

  auto first_run = runs.begin();
  for (unsigned int i = 0; i < element.indices.size(); ++i)
  {
    if (symmetric && i == first_run->end)
      ++first_run;
    const unsigned int first = symmetric ? i : 0;
    const double *const source = condensation.row(local, factor, i, first);
    const unsigned int row = element.indices[i];
    const std::size_t begin = row_begin(row), n = row_begin(row + 1) - begin;
    bool is_mapped = false;
    for (auto run = first_run; run != runs.end(); ++run)
    {
      const unsigned int run_begin = std::max(run->begin, first);
      const unsigned int column_of_run = element.indices[run_begin];
      std::size_t position = run->offset;
      if (position >= n || column(begin + position) != column_of_run)
      {
        if (!is_mapped)
          map_row(row);
        is_mapped = true;
        position = entry_of_column[column_of_run];
        Assert(position < n && column(begin + position) == column_of_run,
               ExcMessage("The pattern lacks an entry of the element."));
      }
      // The next row of an upper triangle begins one column later.
      run->offset = symmetric && position > 0 ? position - 1 : position;
      double *const target = values.data() + begin + position;
      for (unsigned int j = run_begin; j < run->end; ++j)
        target[j - run_begin] += source[j - first];
    }
  }
}

void SubassembledMatrix::vmult_add(double *const destination, const double *const source) const
{
  for (unsigned int row = 0; row < n_rows(); ++row)
  {
    std::size_t k = row_begin(row);
    const std::size_t end = row_begin(row + 1);
    double sum = 0.;
    if (symmetric)
    {
      const double value = source[row];
      if (k < end && column(k) == row) // the diagonal comes first, and has no mirror image
        sum += values[k++] * value;
      for (; k < end; ++k)
      {
        sum += values[k] * source[column(k)];
        destination[column(k)] += values[k] * value;
      }
    }
    else
      for (; k < end; ++k)
        sum += values[k] * source[column(k)];
    destination[row] += sum;
  }
}
} // namespace Gemmule
