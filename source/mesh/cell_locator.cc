// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/mesh/cell_locator.h>

#include <deal.II/grid/tria_accessor.h>
#include <deal.II/grid/tria_iterator.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // In edges of the smallest cells.
  constexpr double round_off = 1e-10;
} // namespace

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
  // The coarse mesh is the same on every rank, and so are all decisions derived from it.
  box = BoxLattice<dim>(triangulation);
  smallest = box.cell_size(triangulation.n_global_levels() - 1);
  cells.clear();
  map = CartesianCellMap<dim>(box.lower);
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      map.insert(cell->vertex(0), box.cell_size(cell->level()), cells.size());
      cells.push_back({cell->active_cell_index(), cell->vertex(0), cell->extent_in_direction(0)});
    }
}

template <int dim>
const typename CellLocator<dim>::Cell *CellLocator<dim>::find(const Point<dim> &x) const
{
  // A point on an upper wall has no cell with larger coordinates.
  Point<dim> inside = x;
  for (unsigned int d = 0; d < dim; ++d)
    if (std::abs(x[d] - box.upper[d]) < round_off * smallest)
      inside[d] = box.upper[d] - 0.5 * smallest;
  const int index = map.find_half_open(inside);
  return index >= 0 ? &cells[index] : nullptr;
}

template class CellLocator<2>;
template class CellLocator<3>;
} // namespace Gemmule
