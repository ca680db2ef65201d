// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/condensed_indices.h>

#include <algorithm>

namespace Gemmule
{
void CondensedIndices::sort()
{
  std::vector<std::pair<dealii::types::global_dof_index, unsigned int>> order; // index, where it stands
  order.reserve(indices.size());
  for (unsigned int k = 0; k < indices.size(); ++k)
    order.emplace_back(indices[k], k);
  std::sort(order.begin(), order.end());

  std::vector<unsigned int> new_position(indices.size());
  unsigned int n_unique = 0;
  for (unsigned int k = 0; k < order.size(); ++k)
  {
    if (k == 0 || order[k].first != order[k - 1].first)
      indices[n_unique++] = order[k].first;
    new_position[order[k].second] = n_unique - 1;
  }
  indices.resize(n_unique);
  for (auto &entry : entries)
    entry.first = new_position[entry.first];
}
} // namespace Gemmule
