// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/lattice_key.h>

#include <deal.II/base/point.h>

#include <cmath>

namespace Gemmule
{
/** Cubes of edge @p size that fill space, one of them with its lower corner at @p origin. */
template <int dim>
struct CubeLattice
{
  dealii::Point<dim> origin;
  double size = 1.;

  /** The cube that holds @p x; of those that share it the one with the larger coordinates. */
  LatticeKey<dim> position_of(const dealii::Point<dim> &x) const
  {
    LatticeKey<dim> key;
    for (unsigned int d = 0; d < dim; ++d)
      key[d] = static_cast<int>(std::floor((x[d] - origin[d]) / size));
    return key;
  }

  /** The cube with that lower corner, which may differ from it by round-off. */
  LatticeKey<dim> position_of_corner(const dealii::Point<dim> &corner) const
  {
    LatticeKey<dim> key;
    for (unsigned int d = 0; d < dim; ++d)
      key[d] = static_cast<int>(std::lround((corner[d] - origin[d]) / size));
    return key;
  }

  /** Lower corner of a cube. */
  dealii::Point<dim> corner(const LatticeKey<dim> &key) const
  {
    dealii::Point<dim> p;
    for (unsigned int d = 0; d < dim; ++d)
      p[d] = origin[d] + key[d] * size;
    return p;
  }
};

/** The cube of twice the size that holds a cube. */
template <int dim>
LatticeKey<dim> parent_position(LatticeKey<dim> key)
{
  for (int &component : key)
    component = component >= 0 ? component / 2 : (component - 1) / 2;
  return key;
}

/** One of the cubes of half the size in a cube, numbered along the first direction first. */
template <int dim>
LatticeKey<dim> child_position(LatticeKey<dim> key, const unsigned int child)
{
  for (unsigned int d = 0; d < dim; ++d)
    key[d] = 2 * key[d] + static_cast<int>((child >> d) & 1);
  return key;
}

/** Carries out @p action on the cubes of the block of 2 @p layers + 1 per direction around @p center, those
 * along the first direction one after the other. */
template <int dim, typename Action>
void for_each_neighbour(const LatticeKey<dim> &center, const int layers, const Action &action)
{
  const int width = 2 * layers + 1, n_cubes = dim == 2 ? width * width : width * width * width;
  for (int i = 0; i < n_cubes; ++i)
  {
    LatticeKey<dim> key;
    for (int d = 0, rest = i; d < dim; ++d, rest /= width)
      key[d] = center[d] + rest % width - layers;
    action(key);
  }
}
} // namespace Gemmule
