// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/unknown_partition.h>

#include <utility>
#include <vector>

namespace Gemmule
{
/**
 * Numbers the unknowns of several fields as those of one system, in blocks such as velocity | pressure |
 * extra fields. A rank's numbers are contiguous, and the blocks follow one another in them:
 *
 *   rank 0: velocity, pressure, extra fields;  rank 1: velocity, pressure, ...
 *
 * so that a vector of the system is an ordinary distributed one, and its block a part of each rank's range.
 * In the numbering of a block alone the ranks' parts of it follow one another.
 */
class BlockNumbering
{
public:
  using Index = UnknownPartition::Index;

  explicit BlockNumbering(MPI_Comm communicator);

  /**
   * @param field how the unknowns of the field are distributed
   * @param block_of_part the block to which each of its parts belongs; blocks are counted from zero
   * @return the number of the field, counted from zero
   */
  unsigned int add_field(const UnknownPartition &field, const std::vector<unsigned int> &block_of_part);

  /** After all fields have been added: finds the numbers. */
  void close();

  /** The number in the system of an unknown that has the number @p index in its field. */
  Index number(unsigned int field, Index index) const;

  unsigned int n_blocks() const { return block_partitions.size(); }
  unsigned int n_fields() const { return fields.size(); }
  /** Unknowns of all ranks. */
  Index size() const { return system.size(); }
  /** Unknowns of one block, on all ranks. */
  Index size(unsigned int block) const { return block_partitions[block].size(); }
  /** Unknowns of one field, on all ranks. */
  Index field_size(unsigned int field) const { return fields[field].size(); }

  /** The numbers that this rank owns: one range. */
  dealii::IndexSet locally_owned() const { return system.owned(rank); }
  /** Those of one block, in the numbering of the system. */
  dealii::IndexSet locally_owned(unsigned int block) const;
  /** Those of one block, in its own numbering. */
  dealii::IndexSet locally_owned_in_block(unsigned int block) const
  {
    return block_partitions[block].owned(rank);
  }
  /** Block, and number in the numbering of the block, of a number of the system. */
  std::pair<unsigned int, Index> block_index(Index number) const;

  MPI_Comm communicator() const { return mpi_communicator; }
  bool operator==(const BlockNumbering &other) const
  {
    return system == other.system && slot_block == other.slot_block;
  }

private:
  MPI_Comm mpi_communicator;
  unsigned int rank;
  std::vector<UnknownPartition> fields;
  std::vector<std::vector<unsigned int>> block_of_part; ///< of each field
  UnknownPartition system;                              ///< its parts: the slots, ordered by block
  std::vector<std::vector<unsigned int>> slots;         ///< [field][part]
  std::vector<unsigned int> slot_block, slot_in_block;
  std::vector<UnknownPartition> block_partitions;
};
} // namespace Gemmule
