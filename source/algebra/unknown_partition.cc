// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/unknown_partition.h>
#include <gemmule/base/gather.h>

#include <algorithm>
#include <numeric>

namespace Gemmule
{
using namespace dealii;

UnknownPartition::UnknownPartition(const std::vector<Index> &n_owned, const MPI_Comm communicator)
    : UnknownPartition(gather_plain(n_owned, communicator), n_owned.size())
{
}

UnknownPartition::UnknownPartition(const std::vector<Index> &n_unknowns, const unsigned int n_parts)
    : parts(n_parts), begin(n_unknowns.size() + 1, 0)
{
  std::partial_sum(n_unknowns.begin(), n_unknowns.end(), begin.begin() + 1);
}

UnknownPartition::Position UnknownPartition::find(const Index number) const
{
  AssertIndexRange(number, size());
  // The last of the ranges that begin at this number: those before it are empty.
  const auto next = std::upper_bound(begin.begin(), begin.end(), number);
  const unsigned int slot = static_cast<unsigned int>(next - begin.begin()) - 1;
  return {slot / parts, slot % parts, number - begin[slot]};
}

IndexSet UnknownPartition::owned(const unsigned int rank) const
{
  IndexSet set(size());
  set.add_range(begin[rank * parts], begin[(rank + 1) * parts]);
  set.compress();
  return set;
}

IndexSet UnknownPartition::owned(const unsigned int rank, const unsigned int part) const
{
  IndexSet set(size());
  set.add_range(begin[rank * parts + part], begin[rank * parts + part + 1]);
  set.compress();
  return set;
}
} // namespace Gemmule
