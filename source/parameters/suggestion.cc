// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/suggestion.h>

#include <algorithm>
#include <cctype>

namespace Gemmule::Parameters
{
unsigned int edit_distance(const std::string &a, const std::string &b)
{
  const auto same = [](const char x, const char y)
  { return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y)); };
  std::vector<std::vector<unsigned int>> cost(a.size() + 1, std::vector<unsigned int>(b.size() + 1));
  for (unsigned int i = 0; i <= a.size(); ++i)
    cost[i][0] = i;
  for (unsigned int j = 0; j <= b.size(); ++j)
    cost[0][j] = j;
  for (unsigned int i = 1; i <= a.size(); ++i)
    for (unsigned int j = 1; j <= b.size(); ++j)
    {
      cost[i][j] = std::min({cost[i - 1][j] + 1, cost[i][j - 1] + 1,
                             cost[i - 1][j - 1] + (same(a[i - 1], b[j - 1]) ? 0u : 1u)});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
        cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 1);
    }
  return cost[a.size()][b.size()];
}

std::string nearest(const std::string &word, const std::vector<std::string> &candidates)
{
  std::string best;
  // A third of the letters: enough for typos and a wrong plural, too little for unrelated words.
  unsigned int best_distance = std::max<unsigned int>(2, word.size() / 3) + 1;
  for (const std::string &candidate : candidates)
  {
    // The distance is at least the difference of the lengths: no table for words that cannot match.
    const std::size_t longer = std::max(word.size(), candidate.size());
    if (longer - std::min(word.size(), candidate.size()) >= best_distance || longer > 200)
      continue;
    const unsigned int distance = edit_distance(word, candidate);
    if (distance < best_distance && distance < std::max(word.size(), candidate.size()))
    {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}
} // namespace Gemmule::Parameters
