// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/union_pattern.h>

#include <algorithm>
#include <cstdint>

namespace Gemmule
{
namespace
{
  constexpr unsigned int word_size = 64;

  /** For each row the elements that have it. */
  struct ElementsOfRows
  {
    std::vector<std::size_t> start;
    std::vector<unsigned int> elements;

    ElementsOfRows(const unsigned int n_rows, const std::vector<CondensedIndices> &all) : start(n_rows + 1, 0)
    {
      for (const auto &element : all)
        for (const auto index : element.indices)
          ++start[index + 1];
      for (unsigned int row = 0; row < n_rows; ++row)
        start[row + 1] += start[row];
      elements.resize(start[n_rows]);
      std::vector<std::size_t> next(start.begin(), start.end() - 1);
      for (unsigned int e = 0; e < all.size(); ++e)
        for (const auto index : all[e].indices)
          elements[next[index]++] = e;
    }

    bool are_those_of_previous(const unsigned int row) const
    {
      return row > 0 && std::equal(elements.begin() + start[row], elements.begin() + start[row + 1],
                                   elements.begin() + start[row - 1], elements.begin() + start[row]);
    }
  };

  /** The unknowns of each element as a set of bits, of which only the words that are not zero are kept. */
  struct ElementBits
  {
    struct Word
    {
      unsigned int number;
      std::uint64_t bits;
    };
    std::vector<std::size_t> start{0};
    std::vector<Word> words;

    explicit ElementBits(const std::vector<CondensedIndices> &elements)
    {
      for (const auto &element : elements)
      {
        for (const auto index : element.indices)
        {
          const unsigned int number = index / word_size;
          if (words.size() == start.back() || words.back().number != number)
            words.push_back({number, 0});
          words.back().bits |= std::uint64_t(1) << (index % word_size);
        }
        start.push_back(words.size());
      }
    }
  };

  /** A set of bits that gives its members in ascending order, and is empty then. */
  class BitSet
  {
  public:
    explicit BitSet(const unsigned int n)
        : words(n / word_size + 1, 0), words_in_use(words.size() / word_size + 1, 0)
    {
    }

    void add(const ElementBits::Word &word)
    {
      words[word.number] |= word.bits;
      words_in_use[word.number / word_size] |= std::uint64_t(1) << (word.number % word_size);
    }

    /** Appends members >= @p smallest; no word was added whose members are all smaller. */
    void move_to(std::vector<unsigned int> &members, const unsigned int smallest)
    {
      const unsigned int first = smallest / word_size;
      words[first] &= ~std::uint64_t(0) << (smallest % word_size);
      for (unsigned int w = first / word_size; w < words_in_use.size(); ++w)
        for (; words_in_use[w] != 0; words_in_use[w] &= words_in_use[w] - 1)
        {
          const unsigned int number = w * word_size + __builtin_ctzll(words_in_use[w]);
          for (; words[number] != 0; words[number] &= words[number] - 1)
            members.push_back(number * word_size + __builtin_ctzll(words[number]));
        }
    }

  private:
    std::vector<std::uint64_t> words, words_in_use;
  };
} // namespace

void UnionPattern::reinit(const unsigned int n_rows, const std::vector<CondensedIndices> &elements,
                          const bool upper)
{
  const ElementsOfRows rows(n_rows, elements);
  const ElementBits bits(elements);
  std::vector<std::size_t> first_word(bits.start.begin(), bits.start.end() - 1);
  BitSet set(n_rows);

  row_start.assign(n_rows + 1, 0);
  columns.clear();
  for (unsigned int row = 0; row < n_rows; ++row)
  {
    if (rows.are_those_of_previous(row))
    {
      // Components of a vector and other unknowns of one node. The first of an upper row is the diagonal.
      const std::size_t begin = row_start[row - 1] + (upper && row_start[row - 1] < columns.size() ? 1 : 0);
      const std::size_t n = columns.size() - begin;
      columns.resize(columns.size() + n);
      std::copy_n(columns.begin() + begin, n, columns.end() - n);
    }
    else
    {
      for (std::size_t k = rows.start[row]; k < rows.start[row + 1]; ++k)
      {
        const unsigned int e = rows.elements[k];
        if (upper) // Rows come in ascending order: words before this one are not needed again.
          while (bits.words[first_word[e]].number < row / word_size)
            ++first_word[e];
        for (std::size_t w = first_word[e]; w < bits.start[e + 1]; ++w)
          set.add(bits.words[w]);
      }
      set.move_to(columns, upper ? row : 0);
    }
    row_start[row + 1] = columns.size();
  }
}

} // namespace Gemmule
