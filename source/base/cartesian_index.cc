// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/cartesian_index.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // In edges of the cell: points that are so near to a face lie on it.
  constexpr double round_off = 1e-10;
} // namespace

template <int dim>
void CartesianCellMap<dim>::insert(const Point<dim> &corner, const double size, const unsigned int id)
{
  unsigned int s = 0;
  while (s < sizes.size() && std::abs(sizes[s].lattice.size - size) > 1e-8 * size)
    ++s;
  if (s == sizes.size())
    sizes.push_back({{origin, size}, {}});
  sizes[s].ids[sizes[s].lattice.position_of_corner(corner)] = id;
}

template <int dim>
int CartesianCellMap<dim>::find_half_open(const Point<dim> &x) const
{
  for (const auto &[lattice, ids] : sizes)
    if (const auto found = ids.find(lattice.position_of(x)); found != ids.end())
      return found->second;
  return -1;
}

template <int dim>
int CartesianCellMap<dim>::find(const Point<dim> &x) const
{
  if (const int id = find_half_open(x); id >= 0)
    return id;
  for (const auto &[lattice, ids] : sizes)
  {
    const LatticeKey<dim> holder = lattice.position_of(x);
    // To the cells beyond the faces that the point lies on.
    LatticeKey<dim> offset{};
    bool is_on_face = false;
    for (unsigned int d = 0; d < dim; ++d)
    {
      const double part = (x[d] - lattice.origin[d]) / lattice.size - holder[d];
      offset[d] = part < round_off ? -1 : (part > 1. - round_off ? 1 : 0);
      is_on_face = is_on_face || offset[d] != 0;
    }
    // Beyond one of the faces, or several: an edge or a corner.
    for (unsigned int faces = 1; is_on_face && faces < (1u << dim); ++faces)
    {
      LatticeKey<dim> key = holder;
      for (unsigned int d = 0; d < dim; ++d)
        if ((faces >> d) & 1)
          key[d] += offset[d];
      if (const auto found = ids.find(key); found != ids.end())
        return found->second;
    }
  }
  return -1;
}

template class CartesianCellMap<2>;
template class CartesianCellMap<3>;
} // namespace Gemmule
