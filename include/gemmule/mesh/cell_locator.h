// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/point.h>
#include <deal.II/grid/tria.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace Gemmule
{
/**
 * Finds the locally owned cell that contains a point, in a mesh of cubes (the Cartesian quadtree or octree of
 * the program), by looking up level and integer coordinates in a hash table: no geometric search, no
 * tolerance.
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
  using Coordinates = std::array<std::uint64_t, dim>;

  /** Coordinates on a grid of 2^finest_level cells per coarse cell, or nothing outside the box. */
  bool integer_coordinates(const dealii::Point<dim> &x, Coordinates &i) const;
  static std::uint64_t key(const Coordinates &i, unsigned int shift);

  // A key has 32 bits per coordinate in 2D and 21 in 3D, of which the coarse cells take the rest.
  static constexpr unsigned int finest_level = dim == 2 ? 20 : 16;
  dealii::Point<dim> origin;
  double finest_size = 1.;
  double smallest = 1.;
  Coordinates n_finest{};
  std::vector<Cell> cells;
  std::vector<std::unordered_map<std::uint64_t, unsigned int>> cell_of_key; ///< by level
  std::vector<unsigned int> used_levels;                                    ///< finest first
};
} // namespace Gemmule
