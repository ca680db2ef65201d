// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/coupling/active_bending.h>

namespace Gemmule
{
using namespace dealii;

template <int dim>
ActiveBending<dim>::ActiveBending(const Triangulation<dim> &triangulation, const BendingModel &model,
                                  const double grid_scale_coefficient, TimerOutput &timer)
    : triangulation(triangulation), model(model), law(model, grid_scale_coefficient), timer(timer)
{
}

template <int dim>
void ActiveBending<dim>::reinit_mesh()
{
  if (bending)
    bending->reinit_mesh();
}

template <int dim>
void ActiveBending<dim>::compute_curvature(const Interface<dim> &interface)
{
  if (!model.is_active() && law.value() == 0.)
  {
    bending.reset();
    return;
  }
  if (!bending)
  {
    bending = std::make_unique<MembraneBending<dim>>(triangulation, law);
    bending->reinit_mesh();
  }
  TimerOutput::Scope scope(timer, "surface: curvature");
  bending->compute_curvature(interface);
}

template <int dim>
void ActiveBending<dim>::compute_moment(const SurfaceSolver<dim> *const surface)
{
  if (bending)
    bending->compute_moment(surface != nullptr ? &surface->concentration() : nullptr,
                            surface != nullptr ? &surface->total_concentration() : nullptr);
}

template class ActiveBending<2>;
template class ActiveBending<3>;
} // namespace Gemmule
