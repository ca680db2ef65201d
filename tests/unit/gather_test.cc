// SPDX-License-Identifier: LGPL-2.1-or-later
// Arrays of all ranks, one behind the other, also where they are longer than a message of MPI.
#include <gemmule/base/exceptions.h>
#include <gemmule/base/gather.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <limits>
#include <new>

using namespace Gemmule;
using namespace dealii;

namespace
{
/** Its 24 bytes are no multiple of the lengths of messages below. */
struct Item
{
  unsigned int rank, number;
  double values[2];

  bool operator==(const Item &other) const
  {
    return rank == other.rank && number == other.number && values[0] == other.values[0] &&
           values[1] == other.values[1];
  }
};

/** So many items as rank @p rank has, all of them different. */
std::vector<Item> items_of(const unsigned int rank, const unsigned int n)
{
  std::vector<Item> items;
  for (unsigned int i = 0; i < n; ++i)
    items.push_back({rank, i, {1. / (1. + i), std::numeric_limits<double>::max() / (rank + 1.)}});
  return items;
}

/** Rank r has @p n_items(r) of them. */
template <typename Number>
void expect_gathered(const Number &n_items, const std::size_t most_bytes_at_once)
{
  std::vector<Item> expected;
  for (unsigned int rank = 0; rank < Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD); ++rank)
  {
    const auto items = items_of(rank, n_items(rank));
    expected.insert(expected.end(), items.begin(), items.end());
  }
  const unsigned int here = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const auto all = gather_plain(items_of(here, n_items(here)), MPI_COMM_WORLD, most_bytes_at_once);
  EXPECT_TRUE(all == expected) << all.size() << " instead of " << expected.size() << " with messages of "
                               << most_bytes_at_once;
}
} // namespace

TEST(ParallelGather, AllRanksGetAllItemsInTheOrderOfTheRanksHoweverShortTheMessages)
{
  // One and seven bytes cut items, 24 is one of them, 48 and 1000 hold several, the last one holds all.
  for (const std::size_t most : {std::size_t(1), std::size_t(7), std::size_t(24), std::size_t(48),
                                 std::size_t(1000), ByteGather::longest_message})
  {
    expect_gathered([](const unsigned int) { return 0; }, most);
    expect_gathered([](const unsigned int) { return 1; }, most);
    expect_gathered([](const unsigned int rank) { return 100 + 57 * rank; }, most);
    expect_gathered([](const unsigned int rank) { return rank == 0 ? 0 : 83; }, most);
    expect_gathered([](const unsigned int rank) { return rank == 0 ? 83 : 0; }, most);
  }
}

TEST(ParallelGather, ItemsThatFitExactlyOrByAByteNot)
{
  const unsigned int n_ranks = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  const std::size_t all_bytes = 10 * sizeof(Item) * n_ranks;
  for (const std::size_t most : {all_bytes - 1, all_bytes, all_bytes + 1})
    expect_gathered([](const unsigned int) { return 10; }, most);
}

TEST(ParallelGather, LengthsBeyondTheNumbersOfMpiAreCountedRight)
{
  // Nothing is sent: only the sum is of interest.
  const std::size_t three_gib = std::size_t(3) << 30;
  EXPECT_EQ(ByteGather(three_gib, MPI_COMM_WORLD).n_bytes(),
            three_gib * Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
}

TEST(ParallelGather, WhereOneRankLacksTheMemoryAllRanksSaySo)
{
  const ByteGather pieces(std::size_t(3) << 30, MPI_COMM_WORLD);
  const bool is_last =
      Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) + 1 == Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  std::string message;
  try
  {
    pieces.make_room(
        [&]
        {
          if (is_last)
            throw std::bad_alloc();
        });
  }
  catch (const SimulationError &error)
  {
    message = error.what();
  }
  EXPECT_EQ(message, "What every process keeps of the membrane and the mesh takes " +
                         std::to_string(3 * Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD)) +
                         " GiB, more than there is room for. Choose a coarser mesh, or fewer processes on "
                         "each machine.");
}
