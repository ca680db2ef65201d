// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstddef>

namespace Gemmule
{
/** Position of a cube in a lattice of cubes: the number of edges from the origin, in each direction. */
template <int dim>
using LatticeKey = std::array<int, dim>;

/** Hash of a LatticeKey (FNV-1a), for the unordered containers of the standard library. */
template <int dim>
struct LatticeKeyHash
{
  std::size_t operator()(const LatticeKey<dim> &key) const
  {
    std::size_t hash = 1469598103934665603ull;
    for (const int k : key)
      hash = (hash ^ static_cast<unsigned int>(k)) * 1099511628211ull;
    return hash ^ (hash >> 29);
  }
};
} // namespace Gemmule
