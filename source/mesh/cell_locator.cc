// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/mesh/cell_locator.h>

#include <deal.II/grid/tria_accessor.h>
#include <deal.II/grid/tria_iterator.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
Point<dim> CellLocator<dim>::Cell::unit(const Point<dim> &x) const
{
  Point<dim> p;
  for (unsigned int d = 0; d < dim; ++d)
    p[d] = std::min(1., std::max(0., (x[d] - corner[d]) / size));
  return p;
}

template <int dim>
void CellLocator<dim>::reinit(const Triangulation<dim> &triangulation)
{
  AssertThrow(triangulation.n_global_levels() <= finest_level + 1,
              ExcMessage("The mesh has more than " + std::to_string(finest_level) +
                         " levels of refinement; lower the levels in section \"Mesh\"."));

  // The coarse mesh is the same on every rank, and so are all decisions derived from it.
  Point<dim> upper;
  bool first = true;
  double coarse_size = 1.;
  for (const auto &cell : triangulation.cell_iterators_on_level(0))
  {
    coarse_size = first ? cell->extent_in_direction(0) : coarse_size;
    for (unsigned int d = 0; d < dim; ++d)
    {
      const double low = cell->vertex(0)[d];
      origin[d] = first ? low : std::min(origin[d], low);
      upper[d] = first ? low + coarse_size : std::max(upper[d], low + coarse_size);
    }
    first = false;
  }
  finest_size = std::ldexp(coarse_size, -static_cast<int>(finest_level));
  smallest = std::ldexp(coarse_size, 1 - static_cast<int>(triangulation.n_global_levels()));
  for (unsigned int d = 0; d < dim; ++d)
    n_finest[d] = static_cast<std::uint64_t>(std::llround((upper[d] - origin[d]) / coarse_size))
                  << finest_level;

  cells.clear();
  cell_of_key.assign(finest_level + 1, {});
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      Coordinates i{};
      integer_coordinates(cell->center(), i);
      const unsigned int level = cell->level();
      cell_of_key[level].emplace(key(i, finest_level - level), cells.size());
      cells.push_back({cell->active_cell_index(), cell->vertex(0), cell->extent_in_direction(0)});
    }
  used_levels.clear();
  for (int level = finest_level; level >= 0; --level)
    if (!cell_of_key[level].empty())
      used_levels.push_back(level);
}

template <int dim>
bool CellLocator<dim>::integer_coordinates(const Point<dim> &x, Coordinates &i) const
{
  for (unsigned int d = 0; d < dim; ++d)
  {
    const double s = std::floor((x[d] - origin[d]) / finest_size);
    if (!(s >= 0. && s <= static_cast<double>(n_finest[d])))
      return false;
    i[d] = std::min(static_cast<std::uint64_t>(s), n_finest[d] - 1); // a point on the upper wall
  }
  return true;
}

template <int dim>
std::uint64_t CellLocator<dim>::key(const Coordinates &i, const unsigned int shift)
{
  constexpr unsigned int bits = dim == 2 ? 32 : 21;
  std::uint64_t k = 0;
  for (unsigned int d = 0; d < dim; ++d)
    k = (k << bits) | (i[d] >> shift);
  return k;
}

template <int dim>
const typename CellLocator<dim>::Cell *CellLocator<dim>::find(const Point<dim> &x) const
{
  Coordinates i{};
  if (!integer_coordinates(x, i))
    return nullptr;
  for (const unsigned int level : used_levels)
  {
    const auto entry = cell_of_key[level].find(key(i, finest_level - level));
    if (entry != cell_of_key[level].end())
      return &cells[entry->second];
  }
  return nullptr;
}

template class CellLocator<2>;
template class CellLocator<3>;
} // namespace Gemmule
