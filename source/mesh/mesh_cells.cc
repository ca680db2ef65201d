// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/base/gather.h>
#include <gemmule/mesh/mesh_cells.h>

#include <cmath>
#include <set>

namespace Gemmule
{
using namespace dealii;

namespace
{
  /** Gives cells their integer position; the coarse cells are known on all ranks. */
  template <int dim>
  class CellPositions
  {
  public:
    explicit CellPositions(const Triangulation<dim> &triangulation)
    {
      for (unsigned int d = 0; d < dim; ++d)
        origin[d] = std::numeric_limits<double>::max();
      for (const auto &cell : triangulation.cell_iterators_on_level(0))
      {
        coarse_size = cell->extent_in_direction(0);
        for (unsigned int d = 0; d < dim; ++d)
          origin[d] = std::min(origin[d], cell->vertex(0)[d]);
      }
    }

    MeshCell<dim> of(const typename Triangulation<dim>::cell_iterator &cell) const
    {
      MeshCell<dim> result;
      result.level = cell->level();
      const double size = std::ldexp(coarse_size, -cell->level());
      for (unsigned int d = 0; d < dim; ++d)
        result.position[d] = static_cast<unsigned int>(std::lround((cell->vertex(0)[d] - origin[d]) / size));
      return result;
    }

  private:
    Point<dim> origin;
    double coarse_size = 0.;
  };

  template <int dim>
  using Key = std::pair<unsigned int, std::array<unsigned int, dim>>;
} // namespace

template <int dim>
std::vector<MeshCell<dim>> gather_mesh_cells(const parallel::distributed::Triangulation<dim> &triangulation)
{
  const CellPositions<dim> positions(triangulation);
  std::vector<MeshCell<dim>> local;
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
      local.push_back(positions.of(cell));
  return gather_plain(local, triangulation.get_communicator());
}

template <int dim>
void refine_to_cells(parallel::distributed::Triangulation<dim> &triangulation,
                     const std::vector<MeshCell<dim>> &cells)
{
  const MPI_Comm communicator = triangulation.get_communicator();
  // Whatever has a descendant among the cells has to be refined.
  std::set<Key<dim>> to_refine;
  for (const auto &cell : cells)
  {
    auto position = cell.position;
    for (unsigned int level = cell.level; level > 0; --level)
    {
      for (unsigned int &component : position)
        component /= 2;
      if (!to_refine.insert({level - 1, position}).second)
        break;
    }
  }

  const CellPositions<dim> positions(triangulation);
  while (true)
  {
    unsigned int n_flagged = 0;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        const MeshCell<dim> here = positions.of(cell);
        if (to_refine.count({here.level, here.position}) == 0)
          continue;
        cell->set_refine_flag();
        ++n_flagged;
      }
    if (Utilities::MPI::sum(n_flagged, communicator) == 0)
      break;
    triangulation.execute_coarsening_and_refinement();
  }

  std::set<Key<dim>> wanted;
  for (const auto &cell : cells)
    wanted.insert({cell.level, cell.position});
  unsigned int n_wrong = 0;
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      const MeshCell<dim> here = positions.of(cell);
      n_wrong += wanted.count({here.level, here.position}) == 0;
    }
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
