// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/gather.h>
#include <gemmule/mesh/mesh_adaptation.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

template <int dim>
MeshAdaptation<dim>::MeshAdaptation(Triangulation &triangulation, const Parameters::Mesh &parameters,
                                    const double phase_boundary_width)
    : triangulation(triangulation),
      parameters(parameters), context{parameters, BoxLattice<dim>(triangulation), phase_boundary_width},
      finest_level(parameters.largest_level()), membrane_criteria(make_membrane_criteria(context)),
      cell_criteria(make_cell_criteria(context)), balance(triangulation)
{
}

template <int dim>
typename MeshAdaptation<dim>::Key
MeshAdaptation<dim>::key(const typename Triangulation::cell_iterator &cell) const
{
  return context.box.position_of_corner(cell->vertex(0), cell->level());
}

template <int dim>
template <typename Sample, typename Criterion>
typename MeshAdaptation<dim>::Levels
MeshAdaptation<dim>::levels(const std::vector<Sample> &samples,
                            const std::vector<std::unique_ptr<Criterion>> &criteria, const double margin)
{
  Levels result(samples.size(), 0);
  for (const auto &criterion : criteria)
  {
    criterion->prepare(samples);
    for (unsigned int i = 0; i < samples.size(); ++i)
      result[i] = std::max(result[i], criterion->level(samples[i], margin));
  }
  return result;
}

template <int dim>
void MeshAdaptation<dim>::insert_with_ancestors(Key key, unsigned int level, NeededCells &needed)
{
  // as far as they are not known yet
  for (; level > 0 && needed[level].insert(key).second; --level)
    key = parent_position<dim>(key);
}

template <int dim>
bool MeshAdaptation<dim>::is_child_needed(const Key &key, const int level, const NeededCells &needed)
{
  // whole families
  if (level + 1 >= static_cast<int>(needed.size()))
    return false;
  for (unsigned int child = 0; child < GeometryInfo<dim>::max_children_per_cell; ++child)
    if (needed[level + 1].count(child_position<dim>(key, child)) > 0)
      return true;
  return false;
}

template <int dim>
typename MeshAdaptation<dim>::NeededCells MeshAdaptation<dim>::needed_cells(const Samples &samples,
                                                                            const Levels &levels,
                                                                            const unsigned int layers) const
{
  NeededCells needed(finest_level + 1), visited(finest_level + 1);
  for (unsigned int s = 0; s < samples.size(); ++s)
  {
    const unsigned int level = limited(levels[s]);
    const Key center = context.box.position_of(samples[s].point, level);
    if (!visited[level].insert(center).second)
      continue;
    for_each_neighbour<dim>(center, layers, [&](const Key &k) { insert_with_ancestors(k, level, needed); });
  }
  return needed;
}

template <int dim>
void MeshAdaptation<dim>::add_needed_cells(const CellSamples &samples, const Levels &levels,
                                           NeededCells &needed) const
{
  for (unsigned int s = 0; s < samples.size(); ++s)
  {
    const unsigned int own_level = samples[s].level;
    const unsigned int level = limited(std::min(levels[s], own_level + 1));
    if (level <= parameters.bulk_level)
      continue;
    Point<dim> center;
    for (unsigned int d = 0; d < dim; ++d)
      center[d] = samples[s].center[d];
    const Key k = context.box.position_of(center, std::min(level, own_level));
    if (level <= own_level)
      insert_with_ancestors(k, level, needed);
    else
      for (unsigned int child = 0; child < GeometryInfo<dim>::max_children_per_cell; ++child)
        insert_with_ancestors(child_position<dim>(k, child), level, needed);
  }
}

template <int dim>
typename MeshAdaptation<dim>::CellSamples MeshAdaptation<dim>::present_cells() const
{
  CellSamples own;
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && cell->level() > static_cast<int>(parameters.bulk_level))
    {
      CellSample<dim> sample{};
      for (unsigned int d = 0; d < dim; ++d)
        sample.center[d] = cell->center()[d];
      sample.level = cell->level();
      own.push_back(sample);
    }
  return gather_plain(own, triangulation.get_communicator());
}

template <int dim>
bool MeshAdaptation<dim>::is_too_coarse(const Samples &samples, const unsigned int layers) const
{
  const NeededCells needed = needed_cells(samples, levels(samples, membrane_criteria, 1.), layers);
  bool too_coarse = false;
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && is_child_needed(key(cell), cell->level(), needed))
    {
      too_coarse = true;
      break;
    }
  return Utilities::MPI::max(static_cast<unsigned int>(too_coarse), triangulation.get_communicator()) > 0;
}

template <int dim>
bool MeshAdaptation<dim>::sweep(const NeededCells &to_refine, const NeededCells &to_keep)
{
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      const Key k = key(cell);
      const int level = cell->level();
      if (is_child_needed(k, level, to_refine))
        cell->set_refine_flag();
      else if (level > static_cast<int>(parameters.bulk_level) &&
               (level >= static_cast<int>(to_keep.size()) || to_keep[level].count(k) == 0))
        cell->set_coarsen_flag();
    }
  // What survives 2:1 balance decides whether anything changes at all.
  triangulation.prepare_coarsening_and_refinement();
  unsigned int n_refined = 0, n_coarsened = 0;
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      n_refined += cell->refine_flag_set();
      n_coarsened += cell->coarsen_flag_set();
    }
  n_refined = Utilities::MPI::sum(n_refined, triangulation.get_communicator());
  n_coarsened = Utilities::MPI::sum(n_coarsened, triangulation.get_communicator());
  if (n_refined + n_coarsened == 0)
    return false;
  const auto cells_before = triangulation.n_global_active_cells();
  triangulation.execute_coarsening_and_refinement();
  // Coarsening alone may be refused by neighbours again and again.
  return n_refined > 0 || triangulation.n_global_active_cells() != cells_before;
}

template <int dim>
std::vector<MeshCell<dim>> MeshAdaptation<dim>::find_membrane_cells(const Samples &samples) const
{
  unsigned int latest = 0;
  for (const auto &sample : samples)
    latest = std::max(latest, sample.time_level);
  const CubeLattice<dim> lattice = context.box.of_level(finest_level);
  const LatticeKey<dim> end = lattice.position_of_corner(context.box.upper);
  LatticeSet<dim> visited;
  std::vector<MeshCell<dim>> cells;
  for (const auto &sample : samples)
    if (const LatticeKey<dim> key = lattice.position_of(sample.point);
        sample.time_level == latest && visited.insert(key).second)
    {
      MeshCell<dim> cell;
      cell.level = finest_level;
      bool is_in_box = true;
      for (unsigned int d = 0; d < dim; ++d)
      {
        is_in_box = is_in_box && key[d] >= 0 && key[d] < end[d];
        cell.position[d] = key[d];
      }
      if (is_in_box)
        cells.push_back(cell);
    }
  return cells;
}

template <int dim>
bool MeshAdaptation<dim>::limit_cells()
{
  if (triangulation.n_global_active_cells() <= parameters.largest_number_of_cells)
    return false;
  // A limit above the finest cells that there are would change nothing.
  const unsigned int present = std::min(triangulation.n_global_levels() - 1, limited(finest_level));
  if (present <= parameters.bulk_level + 1)
    return false;
  n_lowered_levels = finest_level - (present - 1);
  return true;
}

template <int dim>
bool MeshAdaptation<dim>::adapt(const Samples &samples, const CellSamples &cells)
{
  const Levels to_have = levels(samples, membrane_criteria, 1.),
               to_keep = levels(samples, membrane_criteria, parameters.coarsening_margin);
  CellSamples kept;
  Levels cells_to_have, cells_to_keep;
  if (needs_cell_samples() && cells.empty())
  {
    kept = present_cells();
    for (const auto &cell : kept)
      cells_to_keep.push_back(cell.level);
    cells_to_have = cells_to_keep;
  }
  else
  {
    cells_to_have = levels(cells, cell_criteria, 1.);
    cells_to_keep = levels(cells, cell_criteria, parameters.coarsening_margin);
  }
  const CellSamples &cell_samples = kept.empty() ? cells : kept;

  bool changed = false, is_new = true;
  NeededCells refined, left;
  const unsigned int most_sweeps = 4 * finest_level + 4;
  for (unsigned int i = 0; i < most_sweeps; ++i)
  {
    if (is_new)
    {
      refined = needed_cells(samples, to_have, parameters.membrane_layers);
      left = needed_cells(samples, to_keep, parameters.membrane_layers + 1);
      add_needed_cells(cell_samples, cells_to_have, refined);
      add_needed_cells(cell_samples, cells_to_keep, left);
    }
    if (!sweep(refined, left))
      break;
    changed = true;
    is_new = limit_cells();
  }
  if (changed)
    balance.divide_by(find_membrane_cells(samples));
  return changed;
}

template class MeshAdaptation<2>;
template class MeshAdaptation<3>;
} // namespace Gemmule
