// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/cube_lattice.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace Gemmule
{
/** Some cubes of one lattice. */
template <int dim>
using LatticeSet = std::unordered_set<LatticeKey<dim>, LatticeKeyHash<dim>>;

/** Finds the cell of a collection of Cartesian cells (different sizes, no overlap) that holds a point. */
template <int dim>
class CartesianCellMap
{
public:
  /** @param origin all cells are at origin + integer * size: the corner of the box, for example */
  explicit CartesianCellMap(const dealii::Point<dim> &origin = dealii::Point<dim>()) : origin(origin) {}

  void insert(const dealii::Point<dim> &corner, double size, unsigned int id);

  /**
   * @return the id, or -1. A point on a face belongs to the cell with the larger coordinates; if that is none
   * of the collection, to one that touches the point, but for round-off.
   */
  int find(const dealii::Point<dim> &x) const;

  /**
   * The same, but a point on an upper face belongs to no cell if the one with the larger coordinates is none
   * of the collection: each point has one cell at most, also where parts of a mesh are different collections.
   */
  int find_half_open(const dealii::Point<dim> &x) const;

  /** Carries out @p action on the ids of all cells that are not farther from @p x than smallest_size(), and
   * of some more. */
  template <typename Action>
  void visit_nearby(const dealii::Point<dim> &x, const Action &action) const
  {
    for (const auto &cells : sizes)
      for_each_neighbour<dim>(cells.lattice.position_of(x), 1,
                              [&](const LatticeKey<dim> &key)
                              {
                                if (const auto found = cells.ids.find(key); found != cells.ids.end())
                                  action(found->second);
                              });
  }

  /** Edge of the smallest cells; infinite without any. */
  double smallest_size() const
  {
    double smallest = std::numeric_limits<double>::infinity();
    for (const auto &cells : sizes)
      smallest = std::min(smallest, cells.lattice.size);
    return smallest;
  }

private:
  /** The cells of one size. */
  struct CellsOfOneSize
  {
    CubeLattice<dim> lattice;
    std::unordered_map<LatticeKey<dim>, unsigned int, LatticeKeyHash<dim>> ids;
  };

  dealii::Point<dim> origin;
  std::vector<CellsOfOneSize> sizes;
};

/** Points with what belongs to them, sorted into the cubes ("bins") of a lattice, to find those nearby. */
template <int dim, typename T = unsigned int>
class PointBins
{
public:
  PointBins() = default;
  PointBins(const dealii::Point<dim> &origin, const double bin_size) : lattice{origin, bin_size} {}

  void insert(const dealii::Point<dim> &x, T value)
  {
    bins[lattice.position_of(x)].push_back(std::move(value));
  }

  double bin_size() const { return lattice.size; }
  LatticeKey<dim> bin_of(const dealii::Point<dim> &x) const { return lattice.position_of(x); }

  /** Carries out @p action on all that is in the bin of @p x and the bins that touch it: all within a
   * distance of bin_size(), and more. */
  template <typename Action>
  void visit_nearby(const dealii::Point<dim> &x, const Action &action) const
  {
    for_each_neighbour<dim>(bin_of(x), 1, [&](const LatticeKey<dim> &key) { visit_bin(key, action); });
  }

  /** The same for the bins that are exactly @p ring bins away from @p center: rings 0 to n of its bin have
   * all within a distance of n bin_size() of a point. */
  template <typename Action>
  void visit_ring(const LatticeKey<dim> &center, const int ring, const Action &action) const
  {
    for_each_neighbour<dim>(center, ring,
                            [&](const LatticeKey<dim> &key)
                            {
                              int distance = 0;
                              for (unsigned int d = 0; d < dim; ++d)
                                distance = std::max(distance, std::abs(key[d] - center[d]));
                              if (distance == ring)
                                visit_bin(key, action);
                            });
  }

  /** The most that one bin holds. */
  std::size_t largest_bin() const
  {
    std::size_t largest = 0;
    for (const auto &[key, values] : bins)
      largest = std::max(largest, values.size());
    return largest;
  }

private:
  template <typename Action>
  void visit_bin(const LatticeKey<dim> &key, const Action &action) const
  {
    const auto bin = bins.find(key);
    if (bin == bins.end())
      return;
    for (const T &value : bin->second)
      action(value);
  }

  CubeLattice<dim> lattice;
  std::unordered_map<LatticeKey<dim>, std::vector<T>, LatticeKeyHash<dim>> bins;
};
} // namespace Gemmule
