// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/element_condensation.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/types.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

void ElementCondensation::reinit(const CondensedIndices &element)
{
  first_dof.assign(element.indices.size(), numbers::invalid_unsigned_int);
  first_weight.resize(element.indices.size());
  others.clear();
  for (unsigned int i = 0; i < element.n_local(); ++i)
    for (unsigned int k = element.row_start[i]; k < element.row_start[i + 1]; ++k)
    {
      const auto &[unknown, weight] = element.entries[k];
      if (first_dof[unknown] == numbers::invalid_unsigned_int)
      {
        first_dof[unknown] = i;
        first_weight[unknown] = weight;
      }
      else
        others.push_back({unknown, i, weight});
    }
  std::stable_sort(others.begin(), others.end(),
                   [](const Entry &a, const Entry &b) { return a.unknown < b.unknown; });
  sum.resize(element.n_local());
  result.resize(n());
}

std::vector<ElementCondensation::Entry>::const_iterator
ElementCondensation::others_from(const unsigned int unknown) const
{
  return std::lower_bound(others.begin(), others.end(), unknown,
                          [](const Entry &entry, const unsigned int u) { return entry.unknown < u; });
}

const double *ElementCondensation::row(const FullMatrix<double> &local, const double factor,
                                       const unsigned int row, const unsigned int begin)
{
  AssertDimension(local.m(), sum.size());
  AssertIndexRange(row, n());
  const unsigned int n_local = sum.size();

  // T^T local, this row of it
  const double *source = &local(first_dof[row], 0);
  auto other = others_from(row);
  const double row_weight = factor * first_weight[row];
  if (row_weight != 1. || (other != others.end() && other->unknown == row))
  {
    for (unsigned int j = 0; j < n_local; ++j)
      sum[j] = row_weight * source[j];
    for (; other != others.end() && other->unknown == row; ++other)
    {
      const double weight = factor * other->weight;
      const double *const other_source = &local(other->dof, 0);
      for (unsigned int j = 0; j < n_local; ++j)
        sum[j] += weight * other_source[j];
    }
    source = sum.data();
  }

  // times T
  for (unsigned int q = begin; q < n(); ++q)
    result[q] = first_weight[q] * source[first_dof[q]];
  for (auto entry = others_from(begin); entry != others.cend(); ++entry)
    result[entry->unknown] += entry->weight * source[entry->dof];
  return result.data() + begin;
}
} // namespace Gemmule
