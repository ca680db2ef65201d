// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/geometry/cut_geometry.h>

#include <deal.II/grid/tria.h>

namespace Gemmule
{
/** How the cells along the walls of the box lie with respect to the membrane. */
struct WallCells
{
  unsigned int all = 0;
  unsigned int inside = 0;
  /**
   * Inside or cut: the flow needs whole cells of the outer fluid where the velocity is prescribed, so none
   * may be.
   */
  unsigned int not_outside = 0;
};

/** Counts over all ranks. Collective. */
template <int dim>
WallCells count_wall_cells(const dealii::Triangulation<dim> &triangulation, const CutGeometry<dim> &geometry,
                           MPI_Comm communicator);
} // namespace Gemmule
