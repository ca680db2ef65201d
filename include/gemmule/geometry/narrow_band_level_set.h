// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/lattice_key.h>
#include <gemmule/geometry/membrane_snapshot.h>

#include <optional>
#include <unordered_map>
#include <vector>

namespace Gemmule
{
/** Finds the cell of a collection of Cartesian cells (different sizes, no overlap) that holds a point. */
template <int dim>
class CartesianCellMap
{
public:
  explicit CartesianCellMap(const dealii::Point<dim> &origin) : origin(origin) {}

  void insert(const dealii::Point<dim> &corner, double size, unsigned int id);
  /** @return the id, or -1. A point on a face belongs to the cell with the larger coordinates. */
  int find(const dealii::Point<dim> &x) const;

private:
  using Key = LatticeKey<dim>;
  dealii::Point<dim> origin;
  std::vector<double> sizes;
  std::vector<std::unordered_map<Key, unsigned int, LatticeKeyHash<dim>>> cells; ///< for each size
};

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
   * A distance of x from the membrane with the sign of x's side: that of phi within the band, beyond it that
   * of 1/2 - w with the winding number (solid angle in 3D)
   *
   *     w(x) = int (y - x) . n / |y - x|^dim ds(y) / |unit sphere|,
   *
   * 1 inside and 0 outside. Unlike the normal of the closest point, it does not care about corners, or folds
   * within a cell. Without a cloud the sign that @p distance has stays.
   */
  double with_side(double distance, const dealii::Point<dim> &x) const;

private:
  const std::vector<LevelSetCell<dim>> &cells;
  const MembraneCloud<dim> *const cloud;
  CartesianCellMap<dim> map;
};
} // namespace Gemmule
