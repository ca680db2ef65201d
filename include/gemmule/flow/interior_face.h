// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/point.h>

#include <array>

namespace Gemmule
{
/** A face between two active cells that this rank is in charge of. */
struct InteriorFace
{
  unsigned int first;        ///< active_cell_index of the finer cell (of equal ones either)
  unsigned int second;       ///< active_cell_index of the other cell
  unsigned char face_number; ///< of the first cell: 2 direction + side
  /** 0: equal cells; 1 + p: the first cell is finer and lies at the p-th child face of the second. */
  unsigned char refinement;
};

/**
 * A point of the face in the unit coordinates of the first and of the second cell.
 * @param face_number, refinement as in InteriorFace
 */
template <int dim>
std::array<dealii::Point<dim>, 2> on_both_sides(const unsigned int face_number, const unsigned int refinement,
                                                const dealii::Point<dim - 1> &point)
{
  const unsigned int direction = face_number / 2, side = face_number % 2;
  std::array<dealii::Point<dim>, 2> p;
  for (unsigned int d = 0, t = 0; d < dim; ++d)
    if (d == direction)
    {
      p[0][d] = side;
      p[1][d] = 1. - side;
    }
    else
    {
      p[0][d] = point[t];
      p[1][d] = refinement == 0 ? point[t] : 0.5 * (point[t] + (((refinement - 1) >> t) & 1));
      ++t;
    }
  return p;
}
} // namespace Gemmule
