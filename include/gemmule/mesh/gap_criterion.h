// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/cartesian_index.h>
#include <gemmule/mesh/refinement_criterion.h>

#include <vector>

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
  struct Sheet
  {
    dealii::Point<dim> point;
    dealii::Tensor<1, dim> normal;
    unsigned int time_level;
  };
  /** Width of the narrowest gap at a sample, at most the largest distance that is found. */
  double gap(const MembraneSample<dim> &sample) const;

  BoxLattice<dim> box;
  double cells;
  unsigned int membrane_level, finest_level;
  double largest_margin;
  /** One for each level, finest first; their bins are as large as the distances that are found. */
  std::vector<PointBins<dim, Sheet>> sheets;
};
} // namespace Gemmule
