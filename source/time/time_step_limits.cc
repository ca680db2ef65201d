// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/time/time_step_limits.h>

#include <algorithm>

namespace Gemmule
{
namespace
{
  // The band of the level set reaches 2.5 cells from the membrane, and the cells that the membrane cuts after
  // the step have to be in it, with most of their neighbours: centres of up to 0.7 and 1.8 cells from the
  // membrane.
  constexpr double largest_displacement = 0.8;
} // namespace

double TimeStepLimits::longest_step(const double capillary_courant_number) const
{
  return std::min(capillary_courant_number * capillary, largest_displacement * displacement);
}
} // namespace Gemmule
