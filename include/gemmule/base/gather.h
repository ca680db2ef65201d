// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <mpi.h>
#include <type_traits>
#include <vector>

namespace Gemmule
{
/**
 * Brings pieces of memory of all ranks to all ranks, one behind the other in the order of the ranks, however
 * long they are: MPI counts with numbers of type int, so that more than one message may be needed.
 */
class ByteGather
{
public:
  static constexpr std::size_t longest_message = std::numeric_limits<int>::max();

  /**
   * @param n_bytes length of the piece of this rank
   * @param most_bytes_at_once of a message; smaller in tests
   * Collective.
   */
  ByteGather(std::size_t n_bytes, MPI_Comm communicator, std::size_t most_bytes_at_once = longest_message);

  /** Length of all pieces together. */
  std::size_t n_bytes() const { return total; }

  /**
   * Carries out @p allocate, which makes room for all pieces.
   * @throws SimulationError on all ranks if one of them lacks the memory for pieces that need more than one
   * message; std::bad_alloc where shorter ones find no room. Collective.
   */
  void make_room(const std::function<void()> &allocate) const;

  /** Collective. @param all has room for n_bytes() */
  void gather(const void *piece, void *all) const;

private:
  bool fits_one_message() const { return total <= most_bytes_at_once; }

  const MPI_Comm communicator;
  const std::size_t most_bytes_at_once;
  std::vector<std::uint64_t> lengths; ///< of the pieces, by rank
  std::size_t total = 0;
};

/**
 * Concatenation of the ranks' arrays of plain numbers or structs of numbers. Collective.
 * @throws SimulationError on all ranks if the memory of one of them does not hold it
 */
template <typename T>
std::vector<T> gather_plain(const std::vector<T> &local, const MPI_Comm communicator,
                            const std::size_t most_bytes_at_once = ByteGather::longest_message)
{
  static_assert(std::is_trivially_copyable<T>::value, "only plain data can be sent as bytes");
  const ByteGather pieces(local.size() * sizeof(T), communicator, most_bytes_at_once);
  std::vector<T> all;
  pieces.make_room([&] { all.resize(pieces.n_bytes() / sizeof(T)); });
  pieces.gather(local.data(), all.data());
  return all;
}
} // namespace Gemmule
