// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/cartesian_index.h>
#include <gemmule/mesh/box_lattice.h>
#include <gemmule/mesh/mesh_cells.h>

#include <deal.II/distributed/tria.h>

#include <boost/signals2/connection.hpp>
#include <vector>

namespace Gemmule
{
/**
 * Has the mesh divided among the ranks by work instead of by number of cells: those that the membrane cuts
 * count several times.
 *
 * The division depends on the cells of the mesh, membrane_cells() and the number of ranks alone, not on what
 * the mesh was before, if divide() follows each refinement. On one rank there is nothing to divide.
 */
template <int dim>
class LoadBalance
{
public:
  using Triangulation = dealii::parallel::distributed::Triangulation<dim>;

  /** @p triangulation must outlive the object. */
  explicit LoadBalance(Triangulation &triangulation);
  LoadBalance(const LoadBalance &) = delete;
  LoadBalance &operator=(const LoadBalance &) = delete;

  /** By which the mesh is divided. None: all cells count the same. */
  const std::vector<MeshCell<dim>> &membrane_cells() const { return cells; }

  /** Divides the present mesh by membrane_cells(). Collective. */
  void divide() const;

  /**
   * Divides the present mesh, and from now on each new one, by other cells.
   * @param membrane_cells those that the membrane cuts; the mesh may be coarser. The same on all ranks.
   * Collective.
   */
  void divide_by(std::vector<MeshCell<dim>> membrane_cells);

private:
  Triangulation &triangulation;
  const BoxLattice<dim> box;
  std::vector<MeshCell<dim>> cells;
  std::vector<LatticeSet<dim>> heavy; ///< by level: the cells, and all that they are part of
  boost::signals2::scoped_connection weights;
};
} // namespace Gemmule
