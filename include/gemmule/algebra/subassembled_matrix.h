// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/condensed_indices.h>
#include <gemmule/algebra/element_condensation.h>
#include <gemmule/algebra/union_pattern.h>

#include <deal.II/base/partitioner.h>
#include <deal.II/lac/full_matrix.h>

#include <memory>
#include <vector>

namespace Gemmule
{
/**
 * This rank's summand of a sparse matrix: the sum of the matrices of its own elements. The matrix is the sum
 * over the ranks, so that assembly needs no communication; whoever needs whole rows adds them up (a direct
 * solver itself, Trilinos when BlockView hands it the matrix).
 *
 * Rows and columns are counted as the entries of a distributed vector with the same partitioner: the owned
 * unknowns, then those of other ranks that elements of this rank have. Of a symmetric matrix only entries
 * with column >= row in this counting are stored, each of which stands for its mirror image as well.
 */
class SubassembledMatrix
{
public:
  explicit SubassembledMatrix(const bool symmetric) : symmetric(symmetric) {}

  /** Builds the pattern of @p elements, whose indices are local ones, ascending. Values are zero. */
  void reinit(const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &partitioner,
              const std::vector<CondensedIndices> &elements);

  void set_zero();

  /** += factor T^T local T, for an element of those of reinit(). */
  void add(const CondensedIndices &element, const dealii::FullMatrix<double> &local, double factor = 1.);

  /** destination += A source with this rank's entries; arrays of owned and ghost values. */
  void vmult_add(double *destination, const double *source) const;

  bool is_symmetric() const { return symmetric; }
  const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &partitioner() const { return layout; }
  unsigned int n_rows() const { return pattern.n_rows(); }
  std::size_t n_entries() const { return pattern.n_entries(); }
  /** Row r has the entries [row_begin(r), row_begin(r + 1)). */
  std::size_t row_begin(const unsigned int row) const { return pattern.row_begin(row); }
  unsigned int column(const std::size_t entry) const { return pattern.column(entry); }
  const std::vector<double> &entry_values() const { return values; }
  /** Counts the calls of reinit(): what was derived from the pattern is right as long as this stays. */
  unsigned int pattern_version() const { return version; }

private:
  /** Unknowns of an element that follow one another, and so do their entries in each row. */
  struct Run
  {
    unsigned int begin, end; ///< positions in CondensedIndices::indices
    std::size_t offset;      ///< where in the row its first entry is expected: as in the last row
  };
  void find_runs(const CondensedIndices &element);
  /** Sets entry_of_column for the columns of a row. */
  void map_row(unsigned int row);

  const bool symmetric;
  std::shared_ptr<const dealii::Utilities::MPI::Partitioner> layout;
  UnionPattern pattern;
  std::vector<double> values;
  unsigned int version = 0;
  bool is_zero = true;
  ElementCondensation condensation;          ///< of the element that is added
  std::vector<Run> runs;                     ///< of that
  std::vector<unsigned int> entry_of_column; ///< counted from the begin of the row mapped last
};
} // namespace Gemmule
