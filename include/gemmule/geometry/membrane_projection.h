// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/box_tree.h>
#include <gemmule/base/cartesian_index.h>
#include <gemmule/geometry/membrane_snapshot.h>

#include <vector>

namespace Gemmule
{
/** The point of a membrane that is closest to a given point. */
template <int dim>
struct ClosestPoint
{
  dealii::Point<dim> point;      ///< on the membrane
  dealii::Tensor<1, dim> normal; ///< outward
  double distance = 0.;          ///< signed, negative inside
  unsigned int patch = 0;        ///< the patch that holds it
  dealii::Point<dim> unit_point; ///< in the patch's unit coordinates
  bool converged = false;        ///< false: the nearest sample was taken instead
};

/**
 * Closest-point projection onto the zero set of the patches of a MembraneSnapshot: nearest of a set of
 * samples on the membrane, then Newton's method for the stationary points of |x - y|^2 under phi(y) = 0 on
 * the cubic polynomials (Saye, CAMCoS 9, 2014). Works wherever the point lies on the machine, because patches
 * are complete on every rank.
 */
template <int dim>
class MembraneProjection
{
public:
  /** The patches must outlive the object. Throws SimulationError when there are none. */
  MembraneProjection(const std::vector<MembranePatch<dim>> &patches, const dealii::Point<dim> &origin);

  /** Closest point; accurate within a few cells of the membrane, beyond to the spacing of the samples. */
  ClosestPoint<dim> project(const dealii::Point<dim> &x) const;

  /** The same from a good initial guess, for example the result of a nearby point. */
  ClosestPoint<dim> project(const dealii::Point<dim> &x, const ClosestPoint<dim> &guess) const;

  /**
   * Distance to the nearest sample: cheap, error of the order of the sample spacing squared over distance.
   * Beside a corner of the membrane, where the nearest normal can point the wrong way, the best aligned one
   * nearby gives the sign.
   */
  double approximate_distance(const dealii::Point<dim> &x) const;

  /** Samples on the membrane, a few per patch. */
  struct Sample
  {
    dealii::Point<dim> point;
    dealii::Tensor<1, dim> normal;
    dealii::Point<dim> unit_point;
    unsigned int patch;
  };
  const std::vector<Sample> &samples() const { return all_samples; }
  const Sample &nearest(const dealii::Point<dim> &x) const { return all_samples[nearest_sample(x)]; }
  const std::vector<MembranePatch<dim>> &get_patches() const { return patches; }

  /** Value at a closest point of a field of its patch. */
  template <typename T, std::size_t n>
  T value(const ClosestPoint<dim> &p, std::array<T, n> MembraneFields<dim>::*field) const
  {
    return TensorLagrange<dim, 3>::value(patches[p.patch].fields.*field, p.unit_point);
  }

  /** Largest deviation of |grad phi| from one at the samples: has phi drifted from a distance? */
  double distance_drift() const;

  /** Mean curvature div n at a sample (dim - 1 times the inverse radius on a sphere). */
  double curvature(const Sample &sample) const;

private:
  unsigned int nearest_sample(const dealii::Point<dim> &x) const;
  ClosestPoint<dim> newton(const dealii::Point<dim> &x, unsigned int patch, dealii::Point<dim> y) const;

  const std::vector<MembranePatch<dim>> &patches;
  std::vector<Sample> all_samples;
  CartesianCellMap<dim> patch_map;
  PointBins<dim> bins; ///< of the size of the largest patch, with the indices of samples
  std::vector<unsigned int> primary_samples; ///< one per patch, for far points
  BoxTree<dim> primary_tree;                 ///< of primary_samples
};
} // namespace Gemmule
