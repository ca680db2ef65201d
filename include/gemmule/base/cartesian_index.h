// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/cube_lattice.h>

#include <algorithm>
#include <cstdlib>
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

  /**
   * The same for the bins that are exactly @p ring bins away from that of @p x: rings 0 to n have all within
   * a distance of n bin_size().
   * @param reach_square bins whose distance from @p x has a larger square are left out; @p action may make it
   * smaller
   */
  template <typename Action>
  void visit_ring(const dealii::Point<dim> &x, const int ring, const double &reach_square,
                  const Action &action) const
  {
    const LatticeKey<dim> center = bin_of(x);
    for_each_neighbour<dim>(center, ring,
                            [&](const LatticeKey<dim> &key)
                            {
                              int distance = 0;
                              for (unsigned int d = 0; d < dim; ++d)
                                distance = std::max(distance, std::abs(key[d] - center[d]));
                              if (distance == ring && distance_square(x, key) <= reach_square)
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
  /** A lower bound of the square of the distance from a bin. */
  double distance_square(const dealii::Point<dim> &x, const LatticeKey<dim> &key) const
  {
    // A point may lie beside its bin by round-off.
    const double half_width = (0.5 + 1e-8) * lattice.size;
    double sum = 0.;
    for (unsigned int d = 0; d < dim; ++d)
    {
      const double center = lattice.origin[d] + (key[d] + 0.5) * lattice.size;
      const double outside = std::max(std::abs(x[d] - center) - half_width, 0.);
      sum += outside * outside;
    }
    return sum;
  }

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
