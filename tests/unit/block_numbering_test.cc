// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/block_numbering.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

namespace Gemmule
{
namespace
{
  using namespace dealii;

  unsigned int this_rank()
  {
    return Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  }

  /** Two fields of velocity and pressure, and one more; other numbers of unknowns on each rank. */
  BlockNumbering two_fluids_and_a_field()
  {
    const UnknownPartition::Index r = this_rank();
    BlockNumbering numbering(MPI_COMM_WORLD);
    numbering.add_field(UnknownPartition({5 + r, 2}, MPI_COMM_WORLD), {0, 1});
    numbering.add_field(UnknownPartition({0, 3 * r}, MPI_COMM_WORLD), {0, 1});
    numbering.add_field(UnknownPartition({4}, MPI_COMM_WORLD), {2});
    numbering.close();
    return numbering;
  }

  TEST(ParallelUnknownPartition, FindsRankAndPartAlsoWherePartsAreEmpty)
  {
    const UnknownPartition partition({3, 0, 2, 0, 4, 1}, 3);
    EXPECT_EQ(partition.n_ranks(), 2u);
    EXPECT_EQ(partition.size(), 10u);
    const unsigned int ranks[] = {0, 0, 0, 0, 0, 1, 1, 1, 1, 1}, parts[] = {0, 0, 0, 2, 2, 1, 1, 1, 1, 2};
    for (unsigned int number = 0; number < 10; ++number)
    {
      const auto position = partition.find(number);
      EXPECT_EQ(position.rank, ranks[number]) << number;
      EXPECT_EQ(position.part, parts[number]) << number;
      EXPECT_EQ(partition.first(position.rank, position.part) + position.offset, number);
    }
  }

  TEST(ParallelBlockNumbering, GivesEachUnknownOneNumberAndEachRankARange)
  {
    const auto numbering = two_fluids_and_a_field();
    std::vector<unsigned int> count(numbering.size(), 0);
    for (unsigned int field = 0; field < numbering.n_fields(); ++field)
      for (UnknownPartition::Index i = 0; i < numbering.field_size(field); ++i)
        ++count[numbering.number(field, i)];
    for (const unsigned int n : count)
      EXPECT_EQ(n, 1u);
    EXPECT_TRUE(numbering.locally_owned().is_contiguous());
    EXPECT_EQ(Utilities::MPI::sum(numbering.locally_owned().n_elements(), MPI_COMM_WORLD), numbering.size());
  }

  TEST(ParallelBlockNumbering, PutsVelocitiesBeforePressuresBeforeExtraFieldsOnEachRank)
  {
    const auto numbering = two_fluids_and_a_field();
    ASSERT_EQ(numbering.n_blocks(), 3u);
    IndexSet all(numbering.size());
    for (unsigned int block = 0; block < 3; ++block)
    {
      const IndexSet owned = numbering.locally_owned(block);
      EXPECT_TRUE(owned.is_contiguous());
      if (block > 0 && owned.n_elements() > 0)
      {
        EXPECT_GE(owned.nth_index_in_set(0), all.largest_range_starting_index() + all.n_elements());
      }
      all.add_indices(owned);
      all.compress();
      EXPECT_EQ(Utilities::MPI::sum(owned.n_elements(), MPI_COMM_WORLD), numbering.size(block));
    }
    EXPECT_EQ(all, numbering.locally_owned());
  }

  TEST(ParallelBlockNumbering, NumbersEachBlockByItself)
  {
    const auto numbering = two_fluids_and_a_field();
    std::vector<IndexSet> met;
    for (unsigned int block = 0; block < 3; ++block)
      met.emplace_back(numbering.size(block));
    for (const auto number : numbering.locally_owned())
    {
      const auto [block, index] = numbering.block_index(number);
      EXPECT_TRUE(numbering.locally_owned(block).is_element(number));
      met[block].add_index(index);
    }
    for (unsigned int block = 0; block < 3; ++block)
      EXPECT_EQ(met[block], numbering.locally_owned_in_block(block));
  }
} // namespace
} // namespace Gemmule
