// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/mpi.h>

#include <numeric>
#include <type_traits>
#include <vector>

namespace Gemmule
{
/** Concatenation of the ranks' arrays of plain numbers or structs of numbers. */
template <typename T>
std::vector<T> gather_plain(const std::vector<T> &local, const MPI_Comm communicator)
{
  static_assert(std::is_trivially_copyable<T>::value, "only plain data can be sent as bytes");
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator);
  const int n_bytes = local.size() * sizeof(T);
  std::vector<int> counts(n_ranks), offsets(n_ranks, 0);
  MPI_Allgather(&n_bytes, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator);
  std::partial_sum(counts.begin(), counts.end() - 1, offsets.begin() + 1);
  std::vector<T> all((offsets.back() + counts.back()) / sizeof(T));
  MPI_Allgatherv(local.data(), n_bytes, MPI_BYTE, all.data(), counts.data(), offsets.data(), MPI_BYTE,
                 communicator);
  return all;
}
} // namespace Gemmule
