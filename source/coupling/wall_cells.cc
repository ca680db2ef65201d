// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/coupling/wall_cells.h>

namespace Gemmule
{
using namespace dealii;

template <int dim>
WallCells count_wall_cells(const Triangulation<dim> &triangulation, const CutGeometry<dim> &geometry,
                           const MPI_Comm communicator)
{
  WallCells count;
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && cell->at_boundary())
    {
      ++count.all;
      count.not_outside += geometry.is_active(cell->active_cell_index(), 0);
      count.inside += geometry.location(cell->active_cell_index()) == CellLocation::inside;
    }
  count.all = Utilities::MPI::sum(count.all, communicator);
  count.not_outside = Utilities::MPI::sum(count.not_outside, communicator);
  count.inside = Utilities::MPI::sum(count.inside, communicator);
  return count;
}

template WallCells count_wall_cells(const Triangulation<2> &, const CutGeometry<2> &, MPI_Comm);
template WallCells count_wall_cells(const Triangulation<3> &, const CutGeometry<3> &, MPI_Comm);
} // namespace Gemmule
