// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/mesh/load_balance.h>

#include <algorithm>
#include <utility>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // CPU time of a step, apart from the direct solvers, of a cell that the membrane cuts over that of one that
  // it does not cut (doc/performance.md).
  constexpr unsigned int weight_of_cut_cell = 10;
} // namespace

template <int dim>
LoadBalance<dim>::LoadBalance(Triangulation &triangulation)
    : triangulation(triangulation), box(triangulation),
      weights(triangulation.signals.weight.connect(
          [this](const typename Triangulation::cell_iterator &cell,
                 const typename Triangulation::CellStatus) -> unsigned int
          {
            const unsigned int level = cell->level();
            const bool is_cut = level < heavy.size() &&
                                heavy[level].count(box.position_of_corner(cell->vertex(0), level)) > 0;
            return is_cut ? weight_of_cut_cell : 1;
          }))
{
}

template <int dim>
void LoadBalance<dim>::divide() const
{
  // Refinement divides the mesh as well, but by the weights of the cells that there were before.
  if (Utilities::MPI::n_mpi_processes(triangulation.get_communicator()) > 1)
    triangulation.repartition();
}

template <int dim>
void LoadBalance<dim>::divide_by(std::vector<MeshCell<dim>> membrane_cells)
{
  cells = std::move(membrane_cells);
  heavy.clear();
  for (const auto &cell : cells)
  {
    heavy.resize(std::max<std::size_t>(heavy.size(), cell.level + 1));
    LatticeKey<dim> key;
    std::copy(cell.position.begin(), cell.position.end(), key.begin());
    // as far as they are not known yet
    for (unsigned int level = cell.level; heavy[level].insert(key).second && level > 0; --level)
      key = parent_position<dim>(key);
  }
  divide();
}

template class LoadBalance<2>;
template class LoadBalance<3>;
} // namespace Gemmule
