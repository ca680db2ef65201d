// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/cube_lattice.h>

#include <deal.II/base/point.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Gemmule
{
/** The box and the edges of its cells: 2^-level times that of the coarse cells. */
template <int dim>
struct BoxLattice
{
  dealii::Point<dim> lower, upper;
  double coarse_size = 1.; ///< edge of the cells of level 0

  BoxLattice() = default;

  /** Coarse cells are known on all ranks: no communication. */
  explicit BoxLattice(const dealii::Triangulation<dim> &triangulation)
  {
    for (unsigned int d = 0; d < dim; ++d)
    {
      lower[d] = std::numeric_limits<double>::max();
      upper[d] = std::numeric_limits<double>::lowest();
    }
    for (const auto &cell : triangulation.cell_iterators_on_level(0))
    {
      coarse_size = cell->extent_in_direction(0);
      for (unsigned int d = 0; d < dim; ++d)
      {
        lower[d] = std::min(lower[d], cell->vertex(0)[d]);
        upper[d] = std::max(upper[d], cell->vertex(0)[d] + coarse_size);
      }
    }
  }

  double cell_size(const unsigned int level) const
  {
    return std::ldexp(coarse_size, -static_cast<int>(level));
  }

  /** The cells of @p level, as many as there are in the box, and beyond it. */
  CubeLattice<dim> of_level(const unsigned int level) const { return {lower, cell_size(level)}; }

  /** Position in the lattice of @p level of the cell with that lower corner. */
  LatticeKey<dim> position_of_corner(const dealii::Point<dim> &corner, const unsigned int level) const
  {
    return of_level(level).position_of_corner(corner);
  }

  /** Position in the lattice of @p level of the cell that holds @p x; of two that share it the upper one. */
  LatticeKey<dim> position_of(const dealii::Point<dim> &x, const unsigned int level) const
  {
    return of_level(level).position_of(x);
  }

  /** Coarsest level whose cells are not larger than @p size; a large level for sizes of zero and below. */
  unsigned int level_for(const double size) const
  {
    constexpr unsigned int largest = 30;
    unsigned int level = 0;
    // A size that is that of a level but for round-off means that level.
    while (level < largest && cell_size(level) > size * (1. + 1e-10))
      ++level;
    return level;
  }

  /** Distance of a point from the nearest wall; negative outside the box. */
  double distance_from_walls(const dealii::Point<dim> &x) const
  {
    double distance = std::numeric_limits<double>::max();
    for (unsigned int d = 0; d < dim; ++d)
      distance = std::min({distance, x[d] - lower[d], upper[d] - x[d]});
    return distance;
  }
};
} // namespace Gemmule
