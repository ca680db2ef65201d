// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/lattice_key.h>
#include <gemmule/mesh/box_lattice.h>
#include <gemmule/parameters/function_bounds.h>

#include <deal.II/base/function.h>
#include <deal.II/base/mpi.h>

#include <functional>
#include <string>
#include <vector>

namespace Gemmule
{
/** A point where a level set changes its sign. Plain data. */
template <int dim>
struct MembraneRoot
{
  std::array<double, dim> coordinates;
  double spacing; ///< the next ones are not farther away than about this
  /** Value beside the point, on the side where it is smaller, and the largest one known of the cell: a
   * continuous function nearly vanishes there, a jump or a pole does not. */
  double remainder, largest_value;

  dealii::Point<dim> point() const
  {
    dealii::Point<dim> p;
    for (unsigned int d = 0; d < dim; ++d)
      p[d] = coordinates[d];
    return p;
  }
};

/** What a search has found, the same on all ranks. */
template <int dim>
struct FoundMembrane
{
  std::vector<MembraneRoot<dim>> roots;
  /** Complaint about a point where the level set is not finite; empty if none was met. */
  std::string not_finite;
  /** Closed parts of the membrane that are smaller than this may have been missed; 0: there are none that the
   * finest cells would resolve. */
  double blind_size = 0.;
  /** The search has ended at this level, because the function changes its sign in too many cells of it; 0: it
   * has not. */
  unsigned int level_with_too_many_cells = 0;
  std::size_t n_cells_of_that_level = 0;
};

/**
 * Finds all cells that the zero set of a function passes through, without a mesh.
 *
 * Cubes are halved as long as bounds of the function (interval arithmetic) allow a zero in them: down to the
 * level of the membrane, and further, down to the finest level, where no partial derivative keeps its sign,
 * so that a closed part could hide. The cubes that remain are sampled. That is the subdivision of Plantinga
 * and Vegter (2004), which loses no part of the zero set that the samples of the finest cells see. Where the
 * bounds exclude too little (a function of very many waves), samples decide from then on, and the result
 * says what size they may miss.
 */
template <int dim>
class MembraneSearch
{
public:
  using Bounds = std::function<FunctionBounds<dim>(const dealii::Point<dim> &corner, double size)>;

  struct Levels
  {
    unsigned int coarsest, membrane, finest;
  };

  /** @p function and @p box must outlive the object. @p largest_number_of_cells of the mesh. */
  MembraneSearch(const dealii::Function<dim> &function, Bounds bounds, const BoxLattice<dim> &box,
                 const Levels &levels, std::size_t largest_number_of_cells);

  /** @p cubes positions of the cells of the coarsest level that this rank looks at. Collective. */
  FoundMembrane<dim> search(std::vector<LatticeKey<dim>> cubes, MPI_Comm communicator) const;

private:
  using Cubes = std::vector<LatticeKey<dim>>;
  /** Values on a lattice of (n + 1)^dim points of a cube. */
  struct Samples;
  /** One level: what is left goes to @p next, what is found to @p result. */
  void visit(const Cubes &cubes, unsigned int level, bool samples_decide, Cubes &next,
             FoundMembrane<dim> &result) const;
  Samples sample(const dealii::Point<dim> &corner, double size, unsigned int n) const;
  /** Adds the root between two samples, which has others at the distance @p spacing. */
  void add_root(const Samples &samples, const std::pair<unsigned int, unsigned int> &pair, double spacing,
                FoundMembrane<dim> &result) const;

  const dealii::Function<dim> &function;
  const Bounds bounds;
  const BoxLattice<dim> &box;
  const Levels levels;
  const std::size_t largest_number_of_cells;
};
} // namespace Gemmule
