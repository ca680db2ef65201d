// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/gather.h>
#include <gemmule/coupling/lost_parts.h>
#include <gemmule/mesh/cell_locator.h>

#include <cmath>
#include <set>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // In edges of the cell: the largest distance of a root from the membrane on the mesh, the error of
  // interpolation that a smooth shape stays below, and the thickness of layers and the radius of curvature
  // that a cell cannot hold.
  constexpr double largest_distance = 0.5;
  constexpr double interpolation_error = 0.05;
  constexpr double thin = 1.;
  constexpr double smallest_radius = 1.;
  // Intervals per direction of the points of a cell that are looked at.
  constexpr unsigned int n_intervals = 6;

  template <int dim>
  LostPart<dim> lost_part(const Point<dim> &place, const BoxLattice<dim> &box, const Point<dim> &corner,
                          const double size, const bool is_whole)
  {
    LostPart<dim> part{};
    for (unsigned int d = 0; d < dim; ++d)
      part.place[d] = place[d];
    part.level = box.level_for(size);
    part.cell = box.position_of_corner(corner, part.level);
    part.is_whole = is_whole;
    return part;
  }

  /** What is lost within one cell with level set @p values; at most one place is named. */
  template <int dim>
  void find_in_cell(const LevelSetCell<dim> &values, const BoxLattice<dim> &box,
                    const ZeroSetDistance<dim> &distance, std::vector<LostPart<dim>> &lost)
  {
    const double h = values.size;
    bool is_blunt = false;
    Point<dim> blunt_place;
    for (unsigned int i = 0; i < Utilities::fixed_power<dim>(n_intervals + 1); ++i)
    {
      Point<dim> unit;
      for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n_intervals + 1)
        unit[d] = static_cast<double>(rest % (n_intervals + 1)) / n_intervals;
      const Point<dim> x = values.corner + h * Tensor<1, dim>(unit);
      const double on_mesh = TensorLagrange<dim, 3>::value(values.level_set, unit);
      if ((on_mesh < 0.) == distance.is_inside(x))
        continue;
      if (std::abs(distance.value(x)) < interpolation_error * h)
        continue;
      if (distance.layer_thickness(x, thin * h) < thin * h)
      {
        lost.push_back(lost_part(x, box, values.corner, h, true));
        return;
      }
      is_blunt = true;
      blunt_place = x;
    }
    if (is_blunt)
      lost.push_back(lost_part(blunt_place, box, values.corner, h, false));
  }
} // namespace

template <int dim>
std::vector<LostPart<dim>>
find_lost_parts(const Interface<dim> &interface, const MembraneProjection<dim> *const membrane,
                const ZeroSetDistance<dim> &distance, const std::vector<MembraneRoot<dim>> &roots,
                const MPI_Comm communicator)
{
  const auto &triangulation = interface.level_set().get_dof_handler().get_triangulation();
  const BoxLattice<dim> box(triangulation);
  CellLocator<dim> locator;
  locator.reinit(triangulation);
  std::vector<LostPart<dim>> lost;
  std::set<unsigned int> cells_at_membrane;
  for (const CutCell<dim> &cell : interface.geometry().cut_cells())
    cells_at_membrane.insert(cell.active_cell_index);
  for (const auto &root : roots)
    if (const auto *const cell = locator.find(root.point()))
    {
      cells_at_membrane.insert(cell->active_cell_index);
      if (membrane == nullptr ||
          std::abs(membrane->project(root.point()).distance) > largest_distance * cell->size)
        lost.push_back(lost_part(root.point(), box, cell->corner, cell->size, true));
      else if (distance.curvature(root.point()) * cell->size > 1. / smallest_radius ||
               distance.thinnest_layer(root.point(), thin * cell->size) < thin * cell->size)
        lost.push_back(lost_part(root.point(), box, cell->corner, cell->size, false));
    }
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && cells_at_membrane.count(cell->active_cell_index()) > 0)
      find_in_cell(interface.level_set().values_on(cell), box, distance, lost);
  return gather_plain(lost, communicator);
}

#define GEMMULE_INSTANTIATE(dim)                                                                             \
  template std::vector<LostPart<dim>> find_lost_parts(                                                       \
      const Interface<dim> &, const MembraneProjection<dim> *, const ZeroSetDistance<dim> &,                 \
      const std::vector<MembraneRoot<dim>> &, MPI_Comm);
GEMMULE_INSTANTIATE(2)
GEMMULE_INSTANTIATE(3)
#undef GEMMULE_INSTANTIATE
} // namespace Gemmule
