// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/condensed_indices.h>

#include <cstddef>
#include <vector>

namespace Gemmule
{
/**
 * The rows of a sparse matrix whose elements couple each of their unknowns with each other: row r has, in
 * ascending order, the unknowns of all elements that have r.
 *
 * A row is a union of bit sets: in 3D hundreds of thousands of rows have hundreds of columns each, every one
 * of which occurs in many elements, so that sorting them would take most of the assembly.
 */
class UnionPattern
{
public:
  /**
   * @param elements with ascending indices smaller than @p n_rows
   * @param upper only columns from the diagonal on
   */
  void reinit(unsigned int n_rows, const std::vector<CondensedIndices> &elements, bool upper);

  unsigned int n_rows() const { return row_start.size() - 1; }
  std::size_t n_entries() const { return columns.size(); }
  /** Row r has the entries [row_begin(r), row_begin(r + 1)). */
  std::size_t row_begin(const unsigned int row) const { return row_start[row]; }
  unsigned int column(const std::size_t entry) const { return columns[entry]; }

private:
  std::vector<std::size_t> row_start{0};
  std::vector<unsigned int> columns;
};
} // namespace Gemmule
