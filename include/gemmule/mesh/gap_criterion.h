// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/lattice_key.h>
#include <gemmule/mesh/refinement_criterion.h>

#include <unordered_map>

namespace Gemmule
{
/**
 * "Cells per gap" cells fit between two sheets of the membrane that face each other, whether the inside (a
 * neck) or the outside (a near-contact) lies between them.
 *
 * Two points belong to sheets that face each other if their normals are more than 143 degrees apart and the
 * line between them is within 60 degrees of the normals; along one sheet normals turn that far only around a
 * tip, where the distance is the thickness of the tip and counts as well. The width of the gap is the part of
 * their difference along the normal. Both points belong to the same time.
 *
 * The distances that matter at each level, "Cells per gap" cells, are the bins of a spatial hash for that
 * level, in which the samples are thinned to an eighth of a bin: a sample looks at a bounded number of
 * others, so that the work is proportional to the number of samples, however fine the mesh is somewhere else.
 */
template <int dim>
class GapCriterion : public MembraneRefinement<dim>
{
public:
  explicit GapCriterion(const RefinementContext<dim> &context);
  void prepare(const std::vector<MembraneSample<dim>> &samples) override;
  unsigned int level(const MembraneSample<dim> &sample, double margin) const override;
  /** The most samples that one bin has after thinning: bounds the work of level(). */
  std::size_t largest_bin() const;

private:
  using Key = LatticeKey<dim>;
  struct Sheet
  {
    dealii::Point<dim> point;
    dealii::Tensor<1, dim> normal;
    unsigned int time_level;
  };
  struct Hash
  {
    double radius; ///< of the bins, and of the distances that are found
    std::unordered_map<Key, std::vector<Sheet>, LatticeKeyHash<dim>> bins;
  };

  Key key(const dealii::Point<dim> &point, double size) const;
  /** Width of the narrowest gap at a sample, at most the radius of the coarsest hash. */
  double gap(const MembraneSample<dim> &sample) const;

  BoxLattice<dim> box;
  double cells;
  unsigned int membrane_level, finest_level;
  double largest_margin;
  std::vector<Hash> hashes; ///< finest first
};
} // namespace Gemmule
