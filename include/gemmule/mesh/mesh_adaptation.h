#pragma once

#include <gemmule/mesh/refinement_criteria.h>

#include <deal.II/distributed/tria.h>

#include <array>
#include <memory>
#include <unordered_set>
#include <vector>

namespace Gemmule
{
/**
 * Refines and coarsens the mesh of cubes so that around every sample of the membrane the given number of
 * layers of cells has at least the level that the criteria ask for there. Works on integer coordinates: no
 * geometric search. All ranks must pass the same samples.
 */
template <int dim>
class MeshAdaptation
{
public:
  using Triangulation = dealii::parallel::distributed::Triangulation<dim>;
  using Samples = std::vector<MembraneSample<dim>>;

  MeshAdaptation(Triangulation &triangulation, const Parameters::Mesh &parameters);

  /** Is some cell within @p layers layers of a sample too coarse? Collective. */
  bool is_too_coarse(const Samples &samples, unsigned int layers) const;

  /**
   * Refines and coarsens until nothing changes. Coarsening leaves one layer more than refinement makes, so
   * that a membrane at rest does not make the mesh flicker. @return whether the mesh has changed. Collective.
   */
  bool adapt(const Samples &samples);

  /** Levels that the limit on the number of cells has taken away so far. */
  unsigned int lowered_levels() const { return n_lowered_levels; }
  /** Continues an earlier run, in which the limit had taken away @p n levels. */
  void set_lowered_levels(const unsigned int n) { n_lowered_levels = n; }

private:
  using Key = std::array<int, dim>;
  struct KeyHash
  {
    std::size_t operator()(const Key &key) const;
  };
  /** For each level the cells that must have at least that level. */
  using NeededCells = std::vector<std::unordered_set<Key, KeyHash>>;

  NeededCells needed_cells(const Samples &samples, unsigned int layers) const;
  Key key(const typename Triangulation::cell_iterator &cell) const;
  /** Refines and coarsens once, by at most one level. @return whether the mesh has changed. Collective. */
  bool sweep(const Samples &samples);

  Triangulation &triangulation;
  Parameters::Mesh parameters;
  std::vector<std::unique_ptr<RefinementCriterion<dim>>> criteria;
  dealii::Point<dim> origin;
  double coarse_size = 0.;
  unsigned int n_lowered_levels = 0;
};
} // namespace Gemmule
