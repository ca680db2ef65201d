// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/mesh/gap_criterion.h>

#include <algorithm>
#include <array>

namespace Gemmule
{
using namespace dealii;

namespace
{
  constexpr double opposite = -0.8; ///< cosine of the angle between the normals, 143 degrees
  constexpr double facing = 0.5;    ///< cosine of the angle between a normal and the line between two points
  constexpr double thinning = 0.125;
} // namespace

template <int dim>
GapCriterion<dim>::GapCriterion(const RefinementContext<dim> &context)
    : box(context.box), cells(context.parameters.cells_per_gap),
      membrane_level(context.parameters.membrane_level), finest_level(context.parameters.largest_level()),
      largest_margin(context.parameters.coarsening_margin)
{
}

template <int dim>
void GapCriterion<dim>::prepare(const std::vector<MembraneSample<dim>> &samples)
{
  sheets.clear();
  // Gaps that are wide enough for the cells of one level need no finer one, and the membrane has its level
  // anyway.
  for (unsigned int level = finest_level; level > membrane_level; --level)
    sheets.emplace_back(box.lower, largest_margin * cells * box.cell_size(level - 1));
  for (auto &bins : sheets)
  {
    // One sample for each small cube, time and orthant of the normal: the sheets in a cube are kept apart.
    const CubeLattice<dim> small_cubes{box.lower, thinning * bins.bin_size()};
    std::array<LatticeSet<dim>, 2 << dim> taken;
    for (const auto &sample : samples)
    {
      AssertIndexRange(sample.time_level, 2);
      unsigned int sheet = sample.time_level << dim;
      for (unsigned int d = 0; d < dim; ++d)
        sheet |= (sample.normal[d] > 0. ? 1u : 0u) << d;
      if (taken[sheet].insert(small_cubes.position_of(sample.point)).second)
        bins.insert(sample.point, {sample.point, sample.normal, sample.time_level});
    }
  }
}

template <int dim>
std::size_t GapCriterion<dim>::largest_bin() const
{
  std::size_t largest = 0;
  for (const auto &bins : sheets)
    largest = std::max(largest, bins.largest_bin());
  return largest;
}

template <int dim>
double GapCriterion<dim>::gap(const MembraneSample<dim> &sample) const
{
  for (const auto &bins : sheets)
  {
    const double radius = bins.bin_size();
    double narrowest = radius;
    bins.visit_nearby(
        sample.point,
        [&](const Sheet &other)
        {
          if (other.time_level != sample.time_level || sample.normal * other.normal > opposite)
            return;
          const Tensor<1, dim> difference = other.point - sample.point;
          const double distance = difference.norm();
          if (distance >= radius)
            return;
          // Seen from both points the other one is on the same side, inside or outside. Thinning leaves up
          // to a quarter of the radius along the sheet: points that are closer face each other anyway.
          const double here = difference * sample.normal, there = -(difference * other.normal);
          if (distance > 0.5 * radius &&
              (here * there < 0. || std::min(std::abs(here), std::abs(there)) < facing * distance))
            return;
          narrowest = std::min(narrowest, 0.5 * std::abs(here + there));
        });
    if (narrowest < radius)
      return narrowest;
  }
  return std::numeric_limits<double>::max();
}

template <int dim>
unsigned int GapCriterion<dim>::level(const MembraneSample<dim> &sample, const double margin) const
{
  const double width = gap(sample);
  return width == std::numeric_limits<double>::max() ? 0 : box.level_for(width / (margin * cells));
}

template class GapCriterion<2>;
template class GapCriterion<3>;
} // namespace Gemmule
