// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/index_set.h>
#include <deal.II/base/types.h>

#include <mpi.h>
#include <vector>

namespace Gemmule
{
/**
 * How unknowns are numbered over the ranks: each rank owns a contiguous range of numbers, and in it one part
 * (the velocities of a flow, its pressures) follows the other. The table of n_ranks x n_parts beginnings is
 * known on every rank, so that owner and part of any number follow without communication.
 */
class UnknownPartition
{
public:
  using Index = dealii::types::global_dof_index;

  UnknownPartition() = default;

  /** @param n_owned unknowns of this rank in each part; as many parts on all ranks. Collective. */
  UnknownPartition(const std::vector<Index> &n_owned, MPI_Comm communicator);

  /** @param n_unknowns of all ranks, [rank * n_parts + part] */
  UnknownPartition(const std::vector<Index> &n_unknowns, unsigned int n_parts);

  unsigned int n_parts() const { return parts; }
  unsigned int n_ranks() const { return parts == 0 ? 0 : (begin.size() - 1) / parts; }

  /** Unknowns of all ranks. */
  Index size() const { return begin.empty() ? 0 : begin.back(); }
  /** Unknowns of one part on one rank. */
  Index size(const unsigned int rank, const unsigned int part) const
  {
    return begin[rank * parts + part + 1] - begin[rank * parts + part];
  }
  /** The first number of one part on one rank. */
  Index first(const unsigned int rank, const unsigned int part) const { return begin[rank * parts + part]; }

  /** Where a number belongs. */
  struct Position
  {
    unsigned int rank, part;
    Index offset; ///< within the part of the rank
  };
  Position find(Index number) const;

  /** The numbers that a rank owns. */
  dealii::IndexSet owned(unsigned int rank) const;
  /** The numbers of one part that a rank owns. */
  dealii::IndexSet owned(unsigned int rank, unsigned int part) const;

  bool operator==(const UnknownPartition &other) const
  {
    return parts == other.parts && begin == other.begin;
  }

private:
  unsigned int parts = 0;
  std::vector<Index> begin; ///< [rank * parts + part], and one entry more
};
} // namespace Gemmule
