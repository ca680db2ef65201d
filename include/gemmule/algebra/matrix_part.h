// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/subassembled_matrix.h>

#include <deal.II/base/index_set.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <mpi.h>
#include <utility>
#include <vector>

namespace Gemmule
{
/** Where a row or column of a SubassembledMatrix goes in a MatrixPart. */
struct MatrixPlace
{
  /** Entries are taken where row and column are of one group; dealii::numbers::invalid_unsigned_int: of none.
   */
  unsigned int group = dealii::numbers::invalid_unsigned_int;
  dealii::types::global_dof_index number = 0; ///< in the part
};

/** Which rows and columns of a matrix make a part of it; both by local row of the SubassembledMatrix. */
struct MatrixPart
{
  std::vector<MatrixPlace> rows;
  std::vector<MatrixPlace> columns;           ///< empty: a symmetric part, with columns as rows
  dealii::IndexSet owned_rows, owned_columns; ///< of this rank, in the part; columns of a symmetric one: none
};

/**
 * Makes @p matrix a part of a weighted sum of matrices with whole rows on their owners, for Trilinos. Rows
 * (columns) with the same number are added. Collective.
 * @param summands symmetric, all with the same partitioner, each with its weight
 */
void extract_part(const std::vector<std::pair<const SubassembledMatrix *, double>> &summands,
                  const MatrixPart &part, MPI_Comm communicator,
                  dealii::TrilinosWrappers::SparseMatrix &matrix);
} // namespace Gemmule
