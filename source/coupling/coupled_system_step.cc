// SPDX-License-Identifier: LGPL-2.1-or-later
// One time step of CoupledSystem.
#include <gemmule/base/exceptions.h>
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/geometry/membrane_transport.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // |grad phi| may drift this far from one before phi is made a distance again.
  constexpr double largest_distance_drift = 0.05;
  // A multiplier keeps the arclength to this part of it.
  constexpr double arclength_tolerance = 1e-7;
  // A given reference arclength is approached by at most this part of it per step.
  constexpr double largest_arclength_change = 1e-3;
} // namespace

template <int dim>
void CoupledSystem<dim>::move_level_set(const MembraneMotion<dim> &motion, const TrialClouds<dim> &clouds)
{
  {
    TimerOutput::Scope scope(timer_output, "geometry: level set");
    interface.move(motion, NarrowBandLevelSet<dim>(history.level_n().narrow_band, origin, &clouds.level_n()),
                   motion.old_membrane().distance_drift() > largest_distance_drift);
  }
  try
  {
    cut_mesh();
    if (!interface.is_accurate())
      throw StepBreakdown("The membrane moves by more than a cell in one time step: the step is too long.");
  }
  catch (const SimulationError &)
  {
    // Should a sign far from the membrane be wrong, it must not stay for the next try.
    interface.forget_far_nodes();
    throw;
  }
}

template <int dim>
double CoupledSystem<dim>::next_arclength() const
{
  const auto &weights = history.level_n().cloud.weights;
  const double arclength = std::accumulate(weights.begin(), weights.end(), 0.);
  const double largest_change = largest_arclength_change * arclength_0;
  return std::clamp(arclength_0, arclength - largest_change, arclength + largest_change);
}

template <int dim>
void CoupledSystem<dim>::make_or_drop_bending()
{
  if (!model.bending().is_active())
    bending.reset();
  else if (!bending)
  {
    bending = std::make_unique<MembraneBending<dim>>(triangulation, model.bending());
    bending->reinit_mesh();
  }
}

template <int dim>
void CoupledSystem<dim>::move_membrane(const MembraneProjection<dim> &membrane, MembraneMotion<dim> &motion,
                                       TrialClouds<dim> &clouds)
{
  const bool is_fitted = has_arclength_multiplier();
  const double target = is_fitted ? next_arclength() : 0.;
  double aim = target;
  bool fits = !is_fitted || motion.fit_measure(clouds.level_n(), aim, area_0) == 0.;
  if (adapt_mesh(membrane, &motion))
    clouds.reinit_mesh();
  move_level_set(motion, clouds);
  // The length is predicted up to the error of the level set; where that is too large, aim differently.
  for (unsigned int i = 0; i < 3 && !fits; ++i)
  {
    const double excess = interface.geometry().measure() - target;
    fits = std::abs(excess) < arclength_tolerance * arclength_0;
    if (!fits)
    {
      aim -= excess;
      motion.fit_measure(clouds.level_n(), aim, area_0);
      move_level_set(motion, clouds);
    }
  }
}

template <int dim>
void CoupledSystem<dim>::advance_phases(const TimeStep &time_step, const TrialClouds<dim> &clouds,
                                        const MembraneProjection<dim> &membrane,
                                        const std::vector<TransportedFields<dim>> &transported,
                                        const CutCellScalar<dim> &predicted,
                                        const MembranePointValues *curvature)
{
  using Fields = MembraneFields<dim>;
  const auto &cut_cells = interface.geometry().cut_cells();
  const unsigned int n_cells = cut_cells.size();
  CutCellVector<dim> velocity(n_cells);
  for (unsigned int c = 0; c < n_cells; ++c)
    velocity[c] = transported[c].advecting_velocity;

  SurfaceStep<dim> step;
  step.time_step = time_step.size();
  step.bdf = time_step.bdf();
  step.clouds = {{&clouds.level_n(), clouds.level_n_minus_1()}};
  step.velocity = &velocity;
  step.predicted_concentration = &predicted;
  step.curvature = curvature;
  std::array<CutCellScalar<dim>, 2> extended;
  CutCellScalar<dim> predicted_total;
  if (surface->needs_extended_fields())
  {
    extended[0] = extend_along_normals(membrane, &Fields::total_concentration, cut_cells);
    predicted_total = extended[0];
    step.extended_total_concentration[0] = &extended[0];
    if (const auto *const level = history.level_n_minus_1())
    {
      extended[1] = extend_along_normals(MembraneProjection<dim>(level->patches, origin),
                                         &Fields::total_concentration, cut_cells);
      for (unsigned int c = 0; c < n_cells; ++c)
        for (unsigned int i = 0; i < Fields::n; ++i)
          predicted_total[c][i] = step.bdf.e1 * extended[0][c][i] + step.bdf.e2 * extended[1][c][i];
      step.extended_total_concentration[1] = &extended[1];
    }
    step.predicted_total_concentration = &predicted_total;
  }
  surface->advance(interface, step);
}

template <int dim>
StepErrors CoupledSystem<dim>::try_step(const double dt)
{
  const double time = history.time() + dt;
  const TimeStep step = history.next_step(dt);
  const MembraneProjection<dim> membrane(history.level_n().patches, origin);
  MembraneMotion<dim> motion(membrane, step);
  TrialClouds<dim> clouds(history, triangulation);
  make_or_drop_bending();
  move_membrane(membrane, motion, clouds);
  const MembranePointValues *const curvature = compute_curvature();

  std::vector<TransportedFields<dim>> transported;
  {
    TimerOutput::Scope scope(timer_output, "geometry: transported fields");
    transported = transport_fields(motion, interface.geometry().cut_cells());
  }
  CutCellScalar<dim> predicted;
  if (surface)
  {
    TimerOutput::Scope scope(timer_output, "surface: phases");
    predicted = predict_concentration(transported, step);
    advance_phases(step, clouds, membrane, transported, predicted, curvature);
  }

  CutCellVector<dim> old_velocity(transported.size());
  for (unsigned int c = 0; c < transported.size(); ++c)
    old_velocity[c] = transported[c].velocity_1_back;
  solve_flow(time, dt, &old_velocity);
  last_computed_time = time;
  trial = {take_snapshot(time, transported), dt, membrane_flow.time_step_limits(interface.geometry())};
  return estimate_step_errors(interface.geometry(), get_flow(), surface.get(), transported, predicted, step,
                              communicator);
}

template StepErrors CoupledSystem<2>::try_step(double);
template StepErrors CoupledSystem<3>::try_step(double);
} // namespace Gemmule
