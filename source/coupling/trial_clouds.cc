// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/coupling/trial_clouds.h>
#include <gemmule/geometry/cloud_refinement.h>

namespace Gemmule
{
template <int dim>
TrialClouds<dim>::TrialClouds(const History<dim> &history, const Triangulation &triangulation)
    : history(history), triangulation(triangulation)
{
  reinit_mesh();
}

template <int dim>
void TrialClouds<dim>::reinit_mesh()
{
  refined_n = refined_cloud(history.level_n(), triangulation);
  refined_n_minus_1.reset();
  if (const auto *const level = history.level_n_minus_1())
    refined_n_minus_1 = refined_cloud(*level, triangulation);
}

template <int dim>
const MembraneCloud<dim> *TrialClouds<dim>::level_n_minus_1() const
{
  if (refined_n_minus_1)
    return &*refined_n_minus_1;
  const auto *const level = history.level_n_minus_1();
  return level != nullptr ? &level->cloud : nullptr;
}

template class TrialClouds<2>;
template class TrialClouds<3>;
} // namespace Gemmule
