// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/union_pattern.h>

#include <gtest/gtest.h>
#include <random>
#include <set>

namespace Gemmule
{
namespace
{
  using Elements = std::vector<CondensedIndices>;

  Elements elements_with(const std::vector<std::set<unsigned int>> &sets)
  {
    Elements elements(sets.size());
    for (unsigned int e = 0; e < sets.size(); ++e)
      elements[e].indices.assign(sets[e].begin(), sets[e].end());
    return elements;
  }

  std::vector<std::vector<unsigned int>> rows_of(const UnionPattern &pattern)
  {
    std::vector<std::vector<unsigned int>> rows(pattern.n_rows());
    for (unsigned int row = 0; row < pattern.n_rows(); ++row)
      for (std::size_t k = pattern.row_begin(row); k < pattern.row_begin(row + 1); ++k)
        rows[row].push_back(pattern.column(k));
    return rows;
  }

  /** The same rows by sets of numbers, element by element. */
  std::vector<std::vector<unsigned int>> united_rows(const unsigned int n_rows, const Elements &elements,
                                                     const bool upper)
  {
    std::vector<std::set<unsigned int>> sets(n_rows);
    for (const auto &element : elements)
      for (const auto row : element.indices)
        for (const auto column : element.indices)
          if (!upper || column >= row)
            sets[row].insert(column);
    std::vector<std::vector<unsigned int>> rows;
    for (const auto &set : sets)
      rows.emplace_back(set.begin(), set.end());
    return rows;
  }

  /** Sets of up to @p largest numbers, half of them next to one another as those of a cell are. */
  Elements random_elements(const unsigned int n_rows, const unsigned int n_elements,
                           const unsigned int largest, std::mt19937 &random)
  {
    std::vector<std::set<unsigned int>> sets(n_elements);
    for (auto &set : sets)
    {
      const unsigned int first = random() % n_rows, size = random() % (largest + 1);
      for (unsigned int k = 0; k < size; ++k)
        set.insert(k % 2 == 0 ? (first + k / 2) % n_rows : random() % n_rows);
    }
    return elements_with(sets);
  }

  TEST(UnionPattern, HasInEachRowTheUnknownsOfAllItsElements)
  {
    std::mt19937 random(1);
    UnionPattern pattern; // the same for all: nothing of an earlier one may be left
    for (const unsigned int n_rows : {1u, 5u, 63u, 64u, 65u, 128u, 1000u, 4095u, 4096u, 4097u, 9000u})
      for (const unsigned int n_elements : {0u, 1u, 3u, 40u, 200u})
        for (const unsigned int largest : {1u, 4u, 60u})
        {
          const Elements elements = random_elements(n_rows, n_elements, largest, random);
          for (const bool upper : {true, false})
          {
            pattern.reinit(n_rows, elements, upper);
            ASSERT_EQ(rows_of(pattern), united_rows(n_rows, elements, upper))
                << n_rows << " rows, " << n_elements << " elements of up to " << largest;
          }
        }
  }

  TEST(UnionPattern, HasNoEntryInRowsWithoutAnElement)
  {
    UnionPattern pattern;
    pattern.reinit(5, elements_with({{1, 3}}), true);
    const std::vector<std::vector<unsigned int>> expected = {{}, {1, 3}, {}, {3}, {}};
    EXPECT_EQ(rows_of(pattern), expected);
  }

  TEST(UnionPattern, IsRightForNeighbouringRowsOfTheSameElements)
  {
    // 70, 71 and 72 are in the same elements, 73 in one of them only.
    const Elements elements = elements_with({{0, 70, 71, 72, 100}, {70, 71, 72, 73}, {2, 70, 71, 72}});
    UnionPattern pattern;
    for (const bool upper : {true, false})
    {
      pattern.reinit(130, elements, upper);
      EXPECT_EQ(rows_of(pattern), united_rows(130, elements, upper));
    }
  }
} // namespace
} // namespace Gemmule
