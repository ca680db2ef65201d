// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/box_tree.h>
#include <gemmule/base/cartesian_index.h>
#include <gemmule/geometry/membrane_snapshot.h>

#include <optional>
#include <vector>

namespace Gemmule
{
/** The level set of an earlier time level in the band around its membrane, whatever the mesh is now. */
template <int dim>
class NarrowBandLevelSet
{
public:
  /**
   * @param cells must outlive the object
   * @param cloud points of the same membrane, which tell the sides beyond the narrow band; must outlive the
   * object
   */
  NarrowBandLevelSet(const std::vector<LevelSetCell<dim>> &cells, const dealii::Point<dim> &origin,
                     const MembraneCloud<dim> *cloud = nullptr);

  /** phi(x), or nothing outside the band. */
  std::optional<double> value(const dealii::Point<dim> &x) const;

  /**
   * A distance of x from the membrane with the sign of x's side: that of phi within the band, or at the
   * nearest point of the band, since the band has the whole membrane. Where phi is too small there to tell a
   * side, it is that of 1/2 - w with the winding number (solid angle in 3D)
   *
   *     w(x) = int (y - x) . n / |y - x|^dim ds(y) / |unit sphere|,
   *
   * 1 inside and 0 outside, a sum over the whole membrane. Unlike the normal of the closest point, it does
   * not care about corners, or folds within a cell. Without a cloud the sign that @p distance has stays.
   */
  double with_side(double distance, const dealii::Point<dim> &x) const;

private:
  /** phi at the point of the band that is nearest to @p x, which is beside the band; nothing if it tells
   * nothing of the side of x. */
  std::optional<double> value_at_edge(const dealii::Point<dim> &x) const;

  const std::vector<LevelSetCell<dim>> &cells;
  const MembraneCloud<dim> *const cloud;
  CartesianCellMap<dim> map;
  mutable std::optional<BoxTree<dim>> tree; ///< of the cells; made when it is needed first
};
} // namespace Gemmule
