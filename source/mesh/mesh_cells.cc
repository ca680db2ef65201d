// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/cartesian_index.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/base/gather.h>
#include <gemmule/mesh/box_lattice.h>
#include <gemmule/mesh/mesh_cells.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

namespace
{
  template <int dim>
  LatticeKey<dim> key_of(const MeshCell<dim> &cell)
  {
    LatticeKey<dim> key;
    std::copy(cell.position.begin(), cell.position.end(), key.begin());
    return key;
  }
} // namespace

template <int dim>
std::vector<MeshCell<dim>> gather_mesh_cells(const parallel::distributed::Triangulation<dim> &triangulation)
{
  const BoxLattice<dim> box(triangulation);
  std::vector<MeshCell<dim>> local;
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      const auto key = box.position_of_corner(cell->vertex(0), cell->level());
      MeshCell<dim> here;
      here.level = cell->level();
      std::copy(key.begin(), key.end(), here.position.begin());
      local.push_back(here);
    }
  return gather_plain(local, triangulation.get_communicator());
}

template <int dim>
void refine_to_cells(parallel::distributed::Triangulation<dim> &triangulation,
                     const std::vector<MeshCell<dim>> &cells)
{
  const MPI_Comm communicator = triangulation.get_communicator();
  // Whatever has a descendant among the cells has to be refined.
  unsigned int finest_level = 0;
  for (const auto &cell : cells)
    finest_level = std::max(finest_level, cell.level);
  std::vector<LatticeSet<dim>> to_refine(finest_level + 1), wanted(finest_level + 1);
  for (const auto &cell : cells)
  {
    LatticeKey<dim> key = key_of(cell);
    wanted[cell.level].insert(key);
    for (unsigned int level = cell.level; level > 0; --level)
    {
      key = parent_position<dim>(key);
      if (!to_refine[level - 1].insert(key).second)
        break;
    }
  }

  const BoxLattice<dim> box(triangulation);
  const auto is_among = [&](const auto &cell, const std::vector<LatticeSet<dim>> &set)
  {
    const unsigned int level = cell->level();
    return level < set.size() && set[level].count(box.position_of_corner(cell->vertex(0), level)) > 0;
  };
  while (true)
  {
    unsigned int n_flagged = 0;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned() && is_among(cell, to_refine))
      {
        cell->set_refine_flag();
        ++n_flagged;
      }
    if (Utilities::MPI::sum(n_flagged, communicator) == 0)
      break;
    triangulation.execute_coarsening_and_refinement();
  }

  unsigned int n_wrong = 0;
  for (const auto &cell : triangulation.active_cell_iterators())
    n_wrong += cell->is_locally_owned() && !is_among(cell, wanted);
  if (Utilities::MPI::sum(n_wrong, communicator) > 0 || triangulation.n_global_active_cells() != cells.size())
    throw SimulationError(
        "The mesh of the checkpoint does not fit into the box: it was written by another "
        "version of gemmule. Resume with that version, or begin a new run in another directory "
        "with --output and without --resume.");
}

#define GEMMULE_INSTANTIATE(dim)                                                                             \
  template std::vector<MeshCell<dim>> gather_mesh_cells(const parallel::distributed::Triangulation<dim> &);  \
  template void refine_to_cells(parallel::distributed::Triangulation<dim> &,                                 \
                                const std::vector<MeshCell<dim>> &);
GEMMULE_INSTANTIATE(2)
GEMMULE_INSTANTIATE(3)
#undef GEMMULE_INSTANTIATE
} // namespace Gemmule
