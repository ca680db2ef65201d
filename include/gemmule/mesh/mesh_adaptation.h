// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/cartesian_index.h>
#include <gemmule/mesh/load_balance.h>
#include <gemmule/mesh/refinement_criteria.h>

#include <deal.II/distributed/tria.h>

#include <array>
#include <memory>
#include <vector>

namespace Gemmule
{
/**
 * Refines and coarsens the mesh of cubes so that around every sample of the membrane the given number of
 * layers of cells has at least the level that the criteria ask for there, and every sampled cell the level
 * that the criteria for cells ask for. Works on integer coordinates: no geometric search. All ranks must pass
 * the same samples.
 */
template <int dim>
class MeshAdaptation
{
public:
  using Triangulation = dealii::parallel::distributed::Triangulation<dim>;
  using Samples = std::vector<MembraneSample<dim>>;
  using CellSamples = std::vector<CellSample<dim>>;

  /** @param phase_boundary_width 10-90 % width of the composition in equilibrium; 0 without phases */
  MeshAdaptation(Triangulation &triangulation, const Parameters::Mesh &parameters,
                 double phase_boundary_width = 0.);

  /** Is some cell within @p layers layers of a sample too coarse? Collective. */
  bool is_too_coarse(const Samples &samples, unsigned int layers) const;

  /**
   * Refines and coarsens until nothing changes, and divides the new mesh among the ranks by work, where the
   * samples of the latest time level tell which cells the membrane cuts. Coarsening leaves one layer more
   * than refinement makes, and keeps what the criteria need with a margin, so that a membrane at rest does
   * not make the mesh flicker.
   * @param cells of the mesh on which the flow was solved last; without any, cells are not coarsened below
   * what they are as long as there are criteria for cells
   * @return whether the mesh has changed. Collective.
   */
  bool adapt(const Samples &samples, const CellSamples &cells = {});

  /** Are there criteria that need samples of cells? */
  bool needs_cell_samples() const { return !cell_criteria.empty(); }

  /** Level that the limit on the number of cells leaves of @p level. */
  unsigned int limited(const unsigned int level) const
  {
    return std::min(level, finest_level - n_lowered_levels);
  }

  /** Levels that the limit on the number of cells has taken away so far: with the mesh and the cells
   * of load_balance(), all that there is to save. */
  unsigned int lowered_levels() const { return n_lowered_levels; }
  /** Continues an earlier run, in which the limit had taken away @p n levels. */
  void set_lowered_levels(const unsigned int n) { n_lowered_levels = n; }

  /** How the mesh is divided among the ranks. */
  LoadBalance<dim> &load_balance() { return balance; }
  const LoadBalance<dim> &load_balance() const { return balance; }

private:
  using Key = LatticeKey<dim>;
  /** For each level the cells that must have at least that level. */
  using NeededCells = std::vector<LatticeSet<dim>>;
  /** The level that is needed at each sample. */
  using Levels = std::vector<unsigned int>;

  template <typename Sample, typename Criterion>
  static Levels levels(const std::vector<Sample> &samples,
                       const std::vector<std::unique_ptr<Criterion>> &criteria, double margin);
  NeededCells needed_cells(const Samples &samples, const Levels &levels, unsigned int layers) const;
  void add_needed_cells(const CellSamples &samples, const Levels &levels, NeededCells &needed) const;
  static void insert_with_ancestors(Key key, unsigned int level, NeededCells &needed);
  static bool is_child_needed(const Key &key, int level, const NeededCells &needed);
  Key key(const typename Triangulation::cell_iterator &cell) const;
  CellSamples present_cells() const;
  /** Refines and coarsens once, by at most one level. @return whether the mesh has changed. Collective. */
  bool sweep(const NeededCells &to_refine, const NeededCells &to_keep);
  /** The cells of the finest level that have samples of the latest time level, each once. */
  std::vector<MeshCell<dim>> find_membrane_cells(const Samples &samples) const;
  /** Lowers the finest level if there are too many cells. @return whether it has. */
  bool limit_cells();

  Triangulation &triangulation;
  const Parameters::Mesh parameters;
  const RefinementContext<dim> context;
  const unsigned int finest_level;
  std::vector<std::unique_ptr<MembraneRefinement<dim>>> membrane_criteria;
  std::vector<std::unique_ptr<CellRefinement<dim>>> cell_criteria;
  unsigned int n_lowered_levels = 0;
  LoadBalance<dim> balance;
};
} // namespace Gemmule
