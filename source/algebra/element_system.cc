// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/element_system.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

ElementSystem::ElementSystem(const MPI_Comm communicator, const bool symmetric)
    : communicator(communicator), symmetric(symmetric), solver(communicator, symmetric)
{
}

void ElementSystem::begin(const unsigned int n_unknowns)
{
  elements_changed = n_unknowns != n;
  n = n_unknowns;
  n_used_elements = 0;
}

unsigned int ElementSystem::add_element(CondensedIndices &&element)
{
  Assert(std::is_sorted(element.indices.begin(), element.indices.end()),
         ExcMessage("ActiveDofs::finish() must be called before an element is added."));
  if (n_used_elements < elements.size())
  {
    elements_changed = elements_changed || elements[n_used_elements].indices != element.indices;
    elements[n_used_elements] = std::move(element);
  }
  else
  {
    elements_changed = true;
    elements.push_back(std::move(element));
  }
  return n_used_elements++;
}

void ElementSystem::finish_elements()
{
  elements_changed = elements_changed || n_used_elements != elements.size();
  elements.resize(n_used_elements);
  // All ranks must agree, because the symbolic factorisation is collective.
  if (!Utilities::MPI::max(static_cast<unsigned int>(elements_changed), communicator))
    return;
  pattern_changed = true;

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

void ElementSystem::zero_matrix()
{
  std::fill(values.begin(), values.end(), 0.);
}

void ElementSystem::add_matrix(const unsigned int e, const FullMatrix<double> &local)
{
  const CondensedIndices &element = elements[e];
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

void ElementSystem::add_inhomogeneity(const unsigned int e, const FullMatrix<double> &local,
                                      std::vector<double> &rhs) const
{
  const CondensedIndices &element = elements[e];
  const auto &g = element.inhomogeneities;
  if (std::all_of(g.begin(), g.end(), [](const double value) { return value == 0.; }))
    return;
  std::vector<double> product(element.n_local(), 0.);
  for (unsigned int i = 0; i < element.n_local(); ++i)
    for (unsigned int j = 0; j < element.n_local(); ++j)
      product[i] -= local(i, j) * g[j];
  element.scatter(product.data(), rhs);
}

void ElementSystem::factorise()
{
  if (pattern_changed)
  {
    std::vector<unsigned int> rows(columns.size());
    for (unsigned int row = 0; row < n; ++row)
      std::fill(rows.begin() + row_start[row], rows.begin() + row_start[row + 1], row);
    solver.analyse(n, rows, columns);
    pattern_changed = false;
  }
  solver.factorise(values);
}

void ElementSystem::solve(std::vector<double> &rhs)
{
  AssertDimension(rhs.size(), n);
  Utilities::MPI::sum(ArrayView<const double>(rhs), communicator, ArrayView<double>(rhs));
  solver.solve(rhs, 1);
  MPI_Bcast(rhs.data(), rhs.size(), MPI_DOUBLE, 0, communicator);
}

void ElementSystem::solve(std::vector<std::vector<double>> &rhs)
{
  std::vector<double> all;
  for (const auto &column : rhs)
  {
    AssertDimension(column.size(), n);
    all.insert(all.end(), column.begin(), column.end());
  }
  Utilities::MPI::sum(ArrayView<const double>(all), communicator, ArrayView<double>(all));
  solver.solve(all, rhs.size());
  MPI_Bcast(all.data(), all.size(), MPI_DOUBLE, 0, communicator);
  for (std::size_t k = 0; k < rhs.size(); ++k)
    std::copy(all.begin() + k * n, all.begin() + (k + 1) * n, rhs[k].begin());
}

std::vector<double> ElementSystem::apply_local_part(const std::vector<double> &x) const
{
  std::vector<double> y(n, 0.);
  for (unsigned int row = 0; row < n; ++row)
    for (std::size_t k = row_start[row]; k < row_start[row + 1]; ++k)
    {
      y[row] += values[k] * x[columns[k]];
      if (symmetric && columns[k] != row)
        y[columns[k]] += values[k] * x[row];
    }
  return y;
}
} // namespace Gemmule
