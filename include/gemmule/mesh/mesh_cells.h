// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/distributed/tria.h>

#include <array>
#include <vector>

namespace Gemmule
{
/** One active cell of the mesh of cubes: its level, and how many cells of that level lie before it per
 * direction. */
template <int dim>
struct MeshCell
{
  unsigned int level;
  std::array<unsigned int, dim> position;
};

/** All active cells of all ranks, complete on every rank. Collective. */
template <int dim>
std::vector<MeshCell<dim>>
gather_mesh_cells(const dealii::parallel::distributed::Triangulation<dim> &triangulation);

/**
 * Refines @p triangulation, which must not be finer anywhere, until its active cells are @p cells.
 *
 * With the setting mesh_reconstruction_after_repartitioning the cells then have the same order as in the mesh
 * that they were taken from, on the same number of ranks.
 *
 * Throws SimulationError when that is impossible. Collective; all ranks must pass the same cells.
 */
template <int dim>
void refine_to_cells(dealii::parallel::distributed::Triangulation<dim> &triangulation,
                     const std::vector<MeshCell<dim>> &cells);
} // namespace Gemmule
