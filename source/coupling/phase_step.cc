// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/coupling/phase_step.h>
#include <gemmule/coupling/step_errors.h>

namespace Gemmule
{
using namespace dealii;

template <int dim>
PhaseStep<dim>::PhaseStep(SurfaceSolver<dim> &surface, const Interface<dim> &interface,
                          const History<dim> &history)
    : surface(surface), interface(interface), history(history)
{
}

template <int dim>
CutCellScalar<dim> PhaseStep<dim>::advance(const TimeStep &step, const TrialClouds<dim> &clouds,
                                           const MembraneProjection<dim> &membrane,
                                           const std::vector<TransportedFields<dim>> &transported,
                                           const MembranePointValues *const curvature)
{
  using Fields = MembraneFields<dim>;
  const auto &cut_cells = interface.geometry().cut_cells();
  const unsigned int n_cells = cut_cells.size();
  CutCellScalar<dim> predicted = predict_concentration(transported, step);
  CutCellVector<dim> velocity(n_cells);
  for (unsigned int c = 0; c < n_cells; ++c)
    velocity[c] = transported[c].advecting_velocity;

  SurfaceStep<dim> surface_step;
  surface_step.time_step = step.size();
  surface_step.bdf = step.bdf();
  surface_step.clouds = {{&clouds.level_n(), clouds.level_n_minus_1()}};
  surface_step.velocity = &velocity;
  surface_step.predicted_concentration = &predicted;
  surface_step.curvature = curvature;
  std::array<CutCellScalar<dim>, 2> extended;
  CutCellScalar<dim> predicted_total;
  if (surface.needs_extended_fields())
  {
    extended[0] = extend_along_normals(membrane, &Fields::total_concentration, cut_cells);
    predicted_total = extended[0];
    surface_step.extended_total_concentration[0] = &extended[0];
    if (const auto *const level = history.level_n_minus_1())
    {
      extended[1] = extend_along_normals(MembraneProjection<dim>(level->patches, level->origin),
                                         &Fields::total_concentration, cut_cells);
      for (unsigned int c = 0; c < n_cells; ++c)
        for (unsigned int i = 0; i < Fields::n; ++i)
          predicted_total[c][i] = step.bdf().e1 * extended[0][c][i] + step.bdf().e2 * extended[1][c][i];
      surface_step.extended_total_concentration[1] = &extended[1];
    }
    surface_step.predicted_total_concentration = &predicted_total;
  }
  surface.advance(interface, surface_step);
  return predicted;
}

template class PhaseStep<2>;
template class PhaseStep<3>;
} // namespace Gemmule
