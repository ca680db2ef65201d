// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/mesh/refinement_criterion.h>

#include <algorithm>
#include <cmath>

namespace Gemmule
{
/**
 * Spreads the estimated error of the flow evenly over the cells: each of N cells may have "Flow error
 * tolerance" / sqrt(N), so that the whole has the tolerance (relative, in the energy norm). A cell may be
 * coarsened when the error of its parent would be below that with a margin: quadratic velocities have errors
 * of second order in the energy norm, over a volume 2^dim times as large.
 */
template <int dim>
class FlowErrorCriterion : public CellRefinement<dim>
{
public:
  explicit FlowErrorCriterion(const RefinementContext<dim> &context)
      : tolerance(context.parameters.flow_error_tolerance)
  {
  }

  void prepare(const std::vector<CellSample<dim>> &samples) override
  {
    allowed = tolerance / std::sqrt(std::max<double>(1., samples.size()));
  }

  unsigned int level(const CellSample<dim> &sample, const double margin) const override
  {
    if (sample.error > allowed)
      return sample.level + 1;
    const double error_of_parent = sample.error * std::pow(2., 2. + 0.5 * dim);
    return margin * error_of_parent < allowed && sample.level > 0 ? sample.level - 1 : sample.level;
  }

private:
  double tolerance;
  double allowed = 0.;
};
} // namespace Gemmule
