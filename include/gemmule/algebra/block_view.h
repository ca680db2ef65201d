// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/linear_system.h>

#include <deal.II/lac/trilinos_block_sparse_matrix.h>
#include <deal.II/lac/trilinos_parallel_block_vector.h>

namespace Gemmule
{
/**
 * The matrix of a LinearSystem in Trilinos' classes, by blocks (velocity | pressure | extra fields), with
 * whole rows on their owners and both triangles: what preconditioners are made from. A snapshot: later
 * changes of the system are not seen.
 */
class BlockView
{
public:
  using Vector = LinearSystem::Vector;
  using BlockVector = dealii::TrilinosWrappers::MPI::BlockVector;

  /** Collective. */
  explicit BlockView(const LinearSystem &system) : BlockView(system.matrix(), system.numbering()) {}
  BlockView(const SubassembledMatrix &matrix, const BlockNumbering &numbering);

  const dealii::TrilinosWrappers::BlockSparseMatrix &matrix() const { return blocks; }
  unsigned int n_blocks() const { return numbering.n_blocks(); }

  /** Zero, by blocks. */
  BlockVector make_vector() const;
  /** The owned values of @p vector of the system. */
  BlockVector to_blocks(const Vector &vector) const;
  /** Sets the owned values of @p vector. */
  void from_blocks(const BlockVector &by_blocks, Vector &vector) const;

private:
  std::vector<dealii::IndexSet> owned_in_blocks() const;

  const BlockNumbering numbering;
  dealii::TrilinosWrappers::BlockSparseMatrix blocks;
};
} // namespace Gemmule
