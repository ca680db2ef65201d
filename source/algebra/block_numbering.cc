// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/block_numbering.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

BlockNumbering::BlockNumbering(const MPI_Comm communicator)
    : mpi_communicator(communicator), rank(Utilities::MPI::this_mpi_process(communicator))
{
}

unsigned int BlockNumbering::add_field(const UnknownPartition &field, const std::vector<unsigned int> &blocks)
{
  AssertDimension(field.n_parts(), blocks.size());
  fields.push_back(field);
  block_of_part.push_back(blocks);
  return fields.size() - 1;
}

void BlockNumbering::close()
{
  Assert(!fields.empty(), ExcMessage("A system needs a field."));
  unsigned int n_blocks = 0;
  slots.clear();
  for (const auto &blocks : block_of_part)
  {
    slots.emplace_back(blocks.size());
    for (const unsigned int block : blocks)
      n_blocks = std::max(n_blocks, block + 1);
  }

  struct Slot
  {
    unsigned int field, part;
  };
  std::vector<Slot> all;
  slot_block.clear();
  slot_in_block.clear();
  std::vector<unsigned int> slots_of_block(n_blocks, 0);
  for (unsigned int block = 0; block < n_blocks; ++block)
    for (unsigned int field = 0; field < fields.size(); ++field)
      for (unsigned int part = 0; part < block_of_part[field].size(); ++part)
        if (block_of_part[field][part] == block)
        {
          slots[field][part] = all.size();
          all.push_back({field, part});
          slot_block.push_back(block);
          slot_in_block.push_back(slots_of_block[block]++);
        }

  const unsigned int n_ranks = fields.front().n_ranks();
  std::vector<Index> sizes;
  std::vector<std::vector<Index>> sizes_of_block(n_blocks);
  for (unsigned int r = 0; r < n_ranks; ++r)
    for (unsigned int s = 0; s < all.size(); ++s)
    {
      sizes.push_back(fields[all[s].field].size(r, all[s].part));
      sizes_of_block[slot_block[s]].push_back(sizes.back());
    }
  system = UnknownPartition(sizes, all.size());
  block_partitions.clear();
  for (unsigned int block = 0; block < n_blocks; ++block)
    block_partitions.emplace_back(sizes_of_block[block], slots_of_block[block]);
}

BlockNumbering::Index BlockNumbering::number(const unsigned int field, const Index index) const
{
  const auto position = fields[field].find(index);
  return system.first(position.rank, slots[field][position.part]) + position.offset;
}

IndexSet BlockNumbering::locally_owned(const unsigned int block) const
{
  IndexSet set(size());
  for (unsigned int s = 0; s < slot_block.size(); ++s)
    if (slot_block[s] == block)
      set.add_indices(system.owned(rank, s));
  set.compress();
  return set;
}

std::pair<unsigned int, BlockNumbering::Index> BlockNumbering::block_index(const Index number) const
{
  const auto position = system.find(number);
  const unsigned int block = slot_block[position.part];
  return {block,
          block_partitions[block].first(position.rank, slot_in_block[position.part]) + position.offset};
}
} // namespace Gemmule
