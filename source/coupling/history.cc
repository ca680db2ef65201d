// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/coupling/history.h>

#include <utility>

namespace Gemmule
{
template <int dim>
void History<dim>::begin(MembraneSnapshot<dim> level, const TimeStepLimits &limits)
{
  levels = {std::move(level), {}, 0., 0., limits};
}

template <int dim>
void History<dim>::accept(MembraneSnapshot<dim> level, const double step, const TimeStepLimits &limits)
{
  levels = {std::move(level), std::move(levels.level_n), step, levels.step_to_n, limits};
}

template class History<2>;
template class History<3>;
} // namespace Gemmule
