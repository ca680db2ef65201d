// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/condensed_indices.h>

#include <algorithm>

namespace Gemmule
{
void CondensedIndices::sort()
{
  auto unique = indices;
  std::sort(unique.begin(), unique.end());
  unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
  for (auto &entry : entries)
    entry.first = std::lower_bound(unique.begin(), unique.end(), indices[entry.first]) - unique.begin();
  indices.swap(unique);
}
} // namespace Gemmule
