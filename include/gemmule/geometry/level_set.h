// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/geometry/level_set_filter.h>
#include <gemmule/geometry/membrane_motion.h>
#include <gemmule/geometry/narrow_band_level_set.h>

#include <deal.II/base/function.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/lac/affine_constraints.h>

#include <functional>
#include <vector>

namespace Gemmule
{
/**
 * The level set phi: continuous Q3, negative inside the vesicle, signed distance in a narrow band around the
 * membrane (elsewhere only its sign matters).
 *
 * Semi-Lagrangian: every step sets phi anew in the narrow band, at each node to the old level set at the
 * node's old position, with the displacement extended constantly along normals so that phi stays close to a
 * distance. The old level set comes as the polynomials on the old cells, so that refinement, coarsening and
 * repartitioning between two steps cost no transfer error. What it has between the nodes of Q2 is
 * smoothed (LevelSetFilter). Where |grad phi| has drifted the step takes distances from the old membrane
 * instead, with the signs of the old level set (doc/method.md).
 */
template <int dim>
class LevelSet
{
public:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

  explicit LevelSet(const dealii::parallel::distributed::Triangulation<dim> &triangulation);

  /** To be called after each change of the mesh. Collective. */
  void reinit_mesh();

  /** Nodal interpolation of a function that need not be a distance. */
  void interpolate(const dealii::Function<dim> &function);

  /**
   * Signed distance from a membrane.
   * @param offset how far the true membrane lies from a closest point, along its normal: moves the membrane
   * of the level set there; nullptr: not at all
   */
  void set_distance(const MembraneProjection<dim> &membrane,
                    const std::function<double(const ClosestPoint<dim> &)> &offset = nullptr);

  /**
   * The same with the sides that a level set of that membrane tells (NarrowBandLevelSet::with_side), which do
   * not depend on the normals beside its corners.
   * @param width least half width of the narrow band, where it takes more than the usual number of cells
   */
  void set_distance(const MembraneProjection<dim> &membrane, const NarrowBandLevelSet<dim> &sides,
                    double width = 0.);

  /**
   * Moves the membrane.
   * @param old_level_set level set of the old time level
   * @param redistance take distances from the old membrane instead of the values of the old level set: O(h^4)
   */
  void advance(const MembraneMotion<dim> &motion, const NarrowBandLevelSet<dim> &old_level_set,
               bool redistance);

  /** The cells with accurate values, complete on every rank: the next step's old level set. Collective. */
  std::vector<LevelSetCell<dim>> gather_narrow_band() const;

  /** All cells of the mesh, complete on every rank. Collective. */
  std::vector<LevelSetCell<dim>> gather_cells() const;

  /** The nodes far from the membrane will be set anew, as on a new mesh. */
  void forget_far_nodes() { far_nodes_are_set = false; }

  /** Have the nodes far from the membrane been set on this mesh? */
  bool is_set_everywhere() const { return far_nodes_are_set; }

  /**
   * Sets all nodes from gather_cells() of an earlier run, with the same mesh but perhaps another number of
   * ranks. Call after reinit_mesh(). Collective.
   * @param set_everywhere is_set_everywhere() of that run: the next step keeps the values far from the
   * membrane
   */
  void restore(const std::vector<LevelSetCell<dim>> &cells, bool set_everywhere);

  /**
   * Are all cells that the membrane cuts in the narrow band of the last step? Elsewhere phi is not that of
   * this membrane, but for its sign. Collective.
   */
  bool is_accurate_around(const CutGeometry<dim> &geometry) const;

  /** phi += amount in the narrow band: moves the membrane inwards by this length (area correction). */
  void shift(double amount);

  /** Nodal values on an owned or ghost cell of the mesh. */
  LevelSetCell<dim> values_on(const typename dealii::Triangulation<dim>::active_cell_iterator &cell) const;

  const dealii::DoFHandler<dim> &get_dof_handler() const { return dof_handler; }
  /** Ghosted, satisfies the hanging-node constraints. */
  const Vector &values() const { return phi; }

private:
  /** Sets the nodes within the narrow band by @p accurate, the others (if never set on this mesh) by the
   * nearest sample, on the side that @p sides tells (nullptr: the normals of the samples). */
  void set_nodes(const MembraneProjection<dim> &membrane,
                 const std::function<double(const dealii::Point<dim> &)> &accurate,
                 const NarrowBandLevelSet<dim> *sides, double least_width = 0.);
  void finish();

  const dealii::parallel::distributed::Triangulation<dim> &triangulation;
  const dealii::FE_Q<dim> fe;
  dealii::DoFHandler<dim> dof_handler;
  dealii::AffineConstraints<double> constraints;
  std::vector<unsigned int> node_to_dof; ///< lexicographic node -> cell dof
  const LevelSetFilter<dim> filter;
  Vector phi;
  bool far_nodes_are_set = false;
  std::vector<bool> is_in_narrow_band; ///< by active_cell_index; empty: no band has been set on this mesh
};
} // namespace Gemmule
