// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/cartesian_index.h>
#include <gemmule/mesh/box_lattice.h>

#include <deal.II/base/point.h>
#include <deal.II/grid/tria.h>

#include <vector>

namespace Gemmule
{
/**
 * Finds the locally owned cell that contains a point, in a mesh of cubes (the Cartesian quadtree or octree of
 * the program), by looking up level and integer coordinates in a hash table: no geometric search.
 *
 * The cells are half-open: a point on a face belongs to the cell with the larger coordinates, except at the
 * upper walls of the box. The decision depends on the point alone, so that every point of a set that all
 * ranks know belongs to exactly one cell of exactly one rank.
 */
template <int dim>
class CellLocator
{
public:
  struct Cell
  {
    unsigned int active_cell_index;
    dealii::Point<dim> corner; ///< lower corner
    double size;               ///< edge length

    /** Unit coordinates of @p x, kept in [0, 1] against round-off. */
    dealii::Point<dim> unit(const dealii::Point<dim> &x) const;
  };

  /** Call after every change of the mesh. Works on each rank alone. */
  void reinit(const dealii::Triangulation<dim> &triangulation);

  /** The owned cell that contains @p x; nullptr if @p x lies in a cell of another rank or outside the box. */
  const Cell *find(const dealii::Point<dim> &x) const;

  /** Edge length of the smallest cells of the mesh (on all ranks). */
  double smallest_size() const { return smallest; }

private:
  BoxLattice<dim> box;
  double smallest = 1.;
  std::vector<Cell> cells;
  CartesianCellMap<dim> map; ///< to indices of cells
};
} // namespace Gemmule
