// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/block_view.h>

#include <deal.II/lac/block_sparsity_pattern.h>

namespace Gemmule
{
using namespace dealii;

BlockView::BlockView(const SubassembledMatrix &matrix, const BlockNumbering &numbering) : numbering(numbering)
{
  const auto &partitioner = *matrix.partitioner();
  // Of each local row, ghosts included, block and number in it.
  std::vector<std::pair<unsigned int, BlockNumbering::Index>> place(matrix.n_rows());
  std::vector<IndexSet> writable;
  for (unsigned int block = 0; block < n_blocks(); ++block)
    writable.emplace_back(numbering.size(block));
  for (unsigned int row = 0; row < matrix.n_rows(); ++row)
  {
    place[row] = numbering.block_index(partitioner.local_to_global(row));
    writable[place[row].first].add_index(place[row].second);
  }
  const auto owned = owned_in_blocks();
  for (unsigned int block = 0; block < n_blocks(); ++block)
  {
    writable[block].add_indices(owned[block]);
    writable[block].compress();
  }

  const auto for_all_entries = [&](const auto &action)
  {
    for (unsigned int row = 0; row < matrix.n_rows(); ++row)
      for (std::size_t k = matrix.row_begin(row); k < matrix.row_begin(row + 1); ++k)
      {
        const unsigned int column = matrix.column(k);
        action(place[row], place[column], matrix.entry_values()[k]);
        if (matrix.is_symmetric() && column != row)
          action(place[column], place[row], matrix.entry_values()[k]);
      }
  };

  TrilinosWrappers::BlockSparsityPattern pattern(owned, owned, writable, numbering.communicator());
  for_all_entries([&](const auto &row, const auto &column, double)
                  { pattern.block(row.first, column.first).add(row.second, column.second); });
  pattern.compress();
  blocks.reinit(pattern);
  for_all_entries([&](const auto &row, const auto &column, const double value)
                  { blocks.block(row.first, column.first).add(row.second, column.second, value); });
  blocks.compress(VectorOperation::add);
}

std::vector<IndexSet> BlockView::owned_in_blocks() const
{
  std::vector<IndexSet> owned;
  for (unsigned int block = 0; block < n_blocks(); ++block)
    owned.push_back(numbering.locally_owned_in_block(block));
  return owned;
}

BlockView::BlockVector BlockView::make_vector() const
{
  return BlockVector(owned_in_blocks(), numbering.communicator());
}

BlockView::BlockVector BlockView::to_blocks(const Vector &vector) const
{
  BlockVector by_blocks = make_vector();
  for (const auto number : vector.locally_owned_elements())
  {
    const auto [block, index] = numbering.block_index(number);
    by_blocks.block(block)(index) = vector(number);
  }
  by_blocks.compress(VectorOperation::insert);
  return by_blocks;
}

void BlockView::from_blocks(const BlockVector &by_blocks, Vector &vector) const
{
  for (const auto number : vector.locally_owned_elements())
  {
    const auto [block, index] = numbering.block_index(number);
    vector(number) = by_blocks.block(block)(index);
  }
}
} // namespace Gemmule
