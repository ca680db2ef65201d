// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_projection.h>
#include <gemmule/geometry/zero_set_distance.h>
#include <gemmule/mesh/membrane_search.h>

#include <mpi.h>
#include <vector>

namespace Gemmule
{
/** A place where the membrane on the mesh is not that of the expression. Plain data. */
template <int dim>
struct LostPart
{
  std::array<double, dim> place;
  LatticeKey<dim> cell; ///< its position in the lattice of its level
  unsigned int level;
  bool is_whole; ///< a vesicle, a filament or a gap has vanished; otherwise the shape is only inaccurate

  dealii::Point<dim> point() const
  {
    dealii::Point<dim> p;
    for (unsigned int d = 0; d < dim; ++d)
      p[d] = place[d];
    return p;
  }
};

/**
 * Compares the membrane on the mesh (zero set of @p interface) with the zero set of the function of which
 * @p distance is the distance and @p roots are points.
 *
 * A part is lost where a root has no membrane of the mesh within half a cell, and where a point of a cell at
 * the membrane is on the wrong side although its distance from the zero set is more than an error of
 * interpolation: there either a layer between two sheets has vanished, or a corner has become blunt.
 * Inaccurate is the membrane, too, where its radius of curvature or the thickness of a layer is below an edge
 * of the cell.
 * @param membrane projection onto the membrane of the interface; nullptr if the mesh has none
 * @return those of all ranks. Collective.
 */
template <int dim>
std::vector<LostPart<dim>>
find_lost_parts(const Interface<dim> &interface, const MembraneProjection<dim> *membrane,
                const ZeroSetDistance<dim> &distance, const std::vector<MembraneRoot<dim>> &roots,
                MPI_Comm communicator);
} // namespace Gemmule
