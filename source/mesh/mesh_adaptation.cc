#include <gemmule/mesh/mesh_adaptation.h>

#include <deal.II/base/mpi.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
std::size_t MeshAdaptation<dim>::KeyHash::operator()(const Key &key) const
{
  std::size_t hash = 1469598103934665603ull;
  for (const int k : key)
    hash = (hash ^ static_cast<unsigned int>(k)) * 1099511628211ull;
  return hash ^ (hash >> 29);
}

template <int dim>
MeshAdaptation<dim>::MeshAdaptation(Triangulation &triangulation, const Parameters::Mesh &parameters)
    : triangulation(triangulation), parameters(parameters),
      criteria(make_refinement_criteria<dim>(parameters))
{
  // Coarse cells are known on all ranks; the lower corner of the box is the least of theirs.
  for (unsigned int d = 0; d < dim; ++d)
    origin[d] = std::numeric_limits<double>::max();
  for (const auto &cell : triangulation.cell_iterators_on_level(0))
  {
    coarse_size = cell->extent_in_direction(0);
    for (unsigned int d = 0; d < dim; ++d)
      origin[d] = std::min(origin[d], cell->vertex(0)[d]);
  }
}

template <int dim>
typename MeshAdaptation<dim>::Key
MeshAdaptation<dim>::key(const typename Triangulation::cell_iterator &cell) const
{
  const double size = std::ldexp(coarse_size, -cell->level());
  Key k;
  for (unsigned int d = 0; d < dim; ++d)
    k[d] = static_cast<int>(std::lround((cell->vertex(0)[d] - origin[d]) / size));
  return k;
}

template <int dim>
typename MeshAdaptation<dim>::NeededCells MeshAdaptation<dim>::needed_cells(const Samples &samples,
                                                                            const unsigned int layers) const
{
  const unsigned int finest_level =
      std::max(parameters.membrane_level, parameters.phase_boundary_level) - n_lowered_levels;
  NeededCells needed(finest_level + 1);
  const int n_layers = layers, width = 2 * n_layers + 1;
  const int n_neighbours = dim == 2 ? width * width : width * width * width;
  for (const auto &sample : samples)
  {
    unsigned int level = 0;
    for (const auto &criterion : criteria)
      level = std::max(level, criterion->level(sample));
    level = std::min(level, finest_level);
    const double size = std::ldexp(coarse_size, -static_cast<int>(level));
    for (int i = 0; i < n_neighbours; ++i)
    {
      Key k;
      for (int d = 0, rest = i; d < dim; ++d, rest /= width)
        k[d] = static_cast<int>(std::floor((sample.point[d] - origin[d]) / size)) + rest % width - n_layers;
      // with its ancestors, as far as they are not known yet
      for (int l = level; l > 0 && needed[l].insert(k).second; --l)
        for (int &component : k)
          component = component >= 0 ? component / 2 : (component - 1) / 2;
    }
  }
  return needed;
}

template <int dim>
bool MeshAdaptation<dim>::is_too_coarse(const Samples &samples, const unsigned int layers) const
{
  const NeededCells needed = needed_cells(samples, layers);
  bool too_coarse = false;
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && cell->level() + 1 < static_cast<int>(needed.size()))
    {
      // needed are whole families: it is enough to look for one child
      Key k = key(cell);
      for (unsigned int child = 0; child < GeometryInfo<dim>::max_children_per_cell && !too_coarse; ++child)
      {
        Key child_key;
        for (unsigned int d = 0; d < dim; ++d)
          child_key[d] = 2 * k[d] + ((child >> d) & 1);
        too_coarse = needed[cell->level() + 1].count(child_key) > 0;
      }
      if (too_coarse)
        break;
    }
  return Utilities::MPI::max(static_cast<unsigned int>(too_coarse), triangulation.get_communicator()) > 0;
}

template <int dim>
bool MeshAdaptation<dim>::sweep(const Samples &samples)
{
  const NeededCells to_refine = needed_cells(samples, parameters.membrane_layers);
  const NeededCells to_keep = needed_cells(samples, parameters.membrane_layers + 1);
  const auto has_needed_child = [&](const Key &k, const int level)
  {
    if (level + 1 >= static_cast<int>(to_refine.size()))
      return false;
    for (unsigned int child = 0; child < GeometryInfo<dim>::max_children_per_cell; ++child)
    {
      Key child_key;
      for (unsigned int d = 0; d < dim; ++d)
        child_key[d] = 2 * k[d] + ((child >> d) & 1);
      if (to_refine[level + 1].count(child_key) > 0)
        return true;
    }
    return false;
  };
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      const Key k = key(cell);
      const int level = cell->level();
      if (has_needed_child(k, level))
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
bool MeshAdaptation<dim>::adapt(const Samples &samples)
{
  bool changed = false;
  const unsigned int most_sweeps = 2 * (parameters.phase_boundary_level + parameters.membrane_level) + 4;
  for (unsigned int i = 0; i < most_sweeps && sweep(samples); ++i)
  {
    changed = true;
    if (triangulation.n_global_active_cells() > parameters.largest_number_of_cells &&
        std::max(parameters.membrane_level, parameters.phase_boundary_level) - n_lowered_levels >
            parameters.bulk_level + 1)
      ++n_lowered_levels;
  }
  return changed;
}

template class MeshAdaptation<2>;
template class MeshAdaptation<3>;
} // namespace Gemmule
