#include <gemmule/algebra/gather.h>
#include <gemmule/application/coupled_system.h>
#include <gemmule/application/initial_checks.h>
#include <gemmule/application/initial_membrane.h>
#include <gemmule/application/wall_cells.h>
#include <gemmule/geometry/cloud_refinement.h>
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/mesh/box_mesh.h>
#include <gemmule/parameters/errors.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // |grad phi| may drift this far from one before phi is made a distance again.
  constexpr double largest_distance_drift = 0.05;
  // The area is corrected to this relative accuracy: round-off of its quadrature.
  constexpr double area_tolerance = 1e-12;
  // A step that is wrong by more than this part of the area has lost the membrane, and is no case for a
  // correction.
  constexpr double largest_area_error = 0.05;
  // The area by the rules of the cut cells jumps where the division of a cell changes, by some 1e-6 on a
  // coarse mesh. Where the area that is wanted lies in such a jump no shift has it; the next step, elsewhere,
  // makes up for it.
  constexpr double largest_remaining_area_error = 1e-4;
  // A multiplier keeps the arclength to this part of it.
  constexpr double arclength_tolerance = 1e-7;
  // A given reference arclength is approached by at most this part of it per step.
  constexpr double largest_arclength_change = 1e-3;
  // Mesh and flow at the start depend on each other when the flow's error is a criterion.
  constexpr unsigned int largest_number_of_initial_meshes = 6;

  /** 10-90 % width of the equilibrium profile (1 + tanh(s / (2 sqrt(2) C))) / 2; 0 without phases. */
  double phase_boundary_width(const Parameters::Membrane &membrane)
  {
    return membrane.tension_model == Parameters::TensionModel::phase_field
               ? 4. * std::sqrt(2.) * std::atanh(0.8) * membrane.cahn_number
               : 0.;
  }

  /** Q2 nodal values as Q3 nodal values of the same polynomial. */
  template <int dim, typename T>
  std::array<T, TensorLagrange<dim, 3>::n> raise_degree(const std::array<T, TensorLagrange<dim, 2>::n> &u)
  {
    using Table = std::array<typename TensorLagrange<dim, 2>::Values, TensorLagrange<dim, 3>::n>;
    static const Table table = []
    {
      Table t;
      for (unsigned int i = 0; i < t.size(); ++i)
        TensorLagrange<dim, 2>::evaluate(TensorLagrange<dim, 3>::node(i), t[i]);
      return t;
    }();
    std::array<T, TensorLagrange<dim, 3>::n> raised{};
    for (unsigned int i = 0; i < raised.size(); ++i)
      for (unsigned int j = 0; j < u.size(); ++j)
        raised[i] += table[i][j] * u[j];
    return raised;
  }
} // namespace

template <int dim>
CoupledSystem<dim>::CoupledSystem(const AllParameters &parameters_, const MPI_Comm communicator_)
    : parameters(parameters_), communicator(communicator_),
      // Rebuilt after each change, the order of the cells does not depend on the history of the mesh: a
      // resumed run sums in the same order as one that was never interrupted.
      triangulation(communicator, dealii::Triangulation<dim>::MeshSmoothing::none,
                    Triangulation::mesh_reconstruction_after_repartitioning),
      origin(
          [this]
          {
            make_box_mesh(triangulation, parameters.domain, parameters.mesh.bulk_level);
            return lower_corner<dim>(parameters.domain);
          }()),
      // Without the communicator: with it, every exception would be preceded by a banner on the screen.
      timer_output(std::cout, TimerOutput::never, TimerOutput::cpu_and_wall_times),
      model(parameters.membrane, parameters.regularisation, parameters.bending), level_set(triangulation),
      membrane_flow(triangulation, parameters, model),
      adaptation(triangulation, parameters.mesh, phase_boundary_width(parameters.membrane))
{
  if (parameters.membrane.tension_model == Parameters::TensionModel::phase_field)
    surface = std::make_unique<SurfaceSolver<dim>>(triangulation, model, parameters.surface);
  if (model.bending().is_active())
    bending = std::make_unique<MembraneBending<dim>>(triangulation, model.bending());
}

template <int dim>
void CoupledSystem<dim>::reinit_mesh()
{
  TimerOutput::Scope scope(timer_output, "mesh: degrees of freedom");
  level_set.reinit_mesh();
  if (surface)
    surface->reinit_mesh();
  if (bending)
    bending->reinit_mesh();
  membrane_flow.reinit_mesh();
  steps_since_remeshing = 0;
}

template <int dim>
void CoupledSystem<dim>::initialise()
{
  const InitialMembrane<dim> initial(parameters, communicator);
  initial.make_mesh(triangulation, level_set, geometry, adaptation);
  // The error of the flow is known once there is a flow: it may ask for another mesh.
  for (unsigned int i = 1;; ++i)
  {
    reinit_mesh();
    initial.make_level_set(origin, level_set, geometry);
    const MembranePointValues *const curvature = compute_curvature();
    if (surface)
      initial.make_phases(level_set, geometry, *surface, curvature);
    area_0 = geometry.enclosed_volume();
    arclength_0 = parameters.arclength.reference_arclength > 0. ? parameters.arclength.reference_arclength
                                                                : geometry.measure();
    solve_flow(0., parameters.time_stepping.initial_step, nullptr);
    sample_flow();
    if (flow_samples.empty() || i == largest_number_of_initial_meshes ||
        !initial.refine_mesh(origin, triangulation, level_set, geometry, adaptation, flow_samples))
      break;
  }

  InitialChecks<dim>(parameters).flow(get_flow().max_velocity());
  start_history(0.);
}

template <int dim>
void CoupledSystem<dim>::start_history(const double time)
{
  std::vector<TransportedFields<dim>> at_rest(geometry.cut_cells().size());
  for (unsigned int c = 0; c < at_rest.size(); ++c)
    for (unsigned int i = 0; i < MembraneFields<dim>::n; ++i)
      at_rest[c].previous_velocity[i] = raise_degree<dim>(get_flow().membrane_velocity()[c].nodal)[i];
  current = take_snapshot(time, at_rest);
  last_computed_time = time;
  previous = MembraneSnapshot<dim>();
  dt_previous = dt_preceding = 0.;
  resist_negative_tension();
  current_capillary_step = membrane_flow.capillary_time_step(geometry);
}

template <int dim>
void CoupledSystem<dim>::check_wall() const
{
  if (count_wall_cells(triangulation, geometry, communicator).not_outside > 0)
    throw SimulationError("The membrane has reached the wall of the box. Use a larger box, or end earlier.");
}

template <int dim>
void CoupledSystem<dim>::check_refined_band() const
{
  const double allowed =
      (1. + 1e-10) * parameters.domain.cell_size(adaptation.limited(parameters.mesh.membrane_level));
  double largest = 0.;
  for (const auto &cell : geometry.cut_cells())
    largest = std::max(largest, cell.size);
  if (Utilities::MPI::max(largest, communicator) > allowed)
    throw SimulationError("The membrane has left the refined cells around it: the step is too long.");
}

template <int dim>
void CoupledSystem<dim>::sample_flow()
{
  flow_samples.clear();
  if (!adaptation.needs_cell_samples())
    return;
  TimerOutput::Scope scope(timer_output, "flow: error estimate");
  const FlowErrorEstimate estimate = get_flow().estimate_error();
  // A flow at rest has no error that would be worth a finer mesh.
  const double norm = std::max(std::sqrt(estimate.norm_square), 1e-12);
  std::vector<CellSample<dim>> own;
  unsigned int k = 0; // the estimate has the owned cells in the order of the mesh
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      CellSample<dim> sample{};
      for (unsigned int d = 0; d < dim; ++d)
        sample.center[d] = cell->center()[d];
      sample.level = cell->level();
      sample.error = std::sqrt(estimate.squares[k++]) / norm;
      own.push_back(sample);
    }
  flow_samples = gather_plain(own, communicator);
}

template <int dim>
std::vector<MembraneSample<dim>> CoupledSystem<dim>::samples(const MembraneProjection<dim> &membrane,
                                                             const MembraneMotion<dim> *motion) const
{
  using Fields = MembraneFields<dim>;
  std::vector<MembraneSample<dim>> result;
  for (const auto &s : membrane.samples())
  {
    ClosestPoint<dim> p;
    p.point = s.point;
    p.normal = s.normal;
    p.patch = s.patch;
    p.unit_point = s.unit_point;
    p.converged = true;
    MembraneSample<dim> sample;
    sample.point = s.point;
    sample.normal = s.normal;
    sample.curvature = membrane.curvature(s);
    if (surface)
      sample.composition =
          membrane.value(p, &Fields::concentration) / membrane.value(p, &Fields::total_concentration);
    result.push_back(sample);
    if (motion != nullptr)
    {
      sample.point += motion->displacement(p);
      result.push_back(sample);
    }
  }
  return result;
}

template <int dim>
void CoupledSystem<dim>::adapt_mesh(const MembraneProjection<dim> &membrane,
                                    const MembraneMotion<dim> *motion)
{
  bool changed = false;
  {
    TimerOutput::Scope scope(timer_output, "mesh: adaptation");
    const auto wanted = samples(membrane, motion);
    ++steps_since_remeshing;
    if (steps_since_remeshing >= parameters.mesh.remeshing_interval || adaptation.is_too_coarse(wanted, 1))
    {
      changed = adaptation.adapt(wanted, flow_samples);
      steps_since_remeshing = 0;
    }
  }
  if (changed)
  {
    ++n_mesh_changes;
    n_steps_on_mesh = 0;
    reinit_mesh();
    refine_cloud(current, triangulation);
    refine_cloud(previous, triangulation);
  }
}

template <int dim>
void CoupledSystem<dim>::cut_mesh(const bool keep_area)
{
  TimerOutput::Scope scope(timer_output, "geometry: cut cells");
  geometry.reinit(level_set.get_dof_handler(), level_set.values());
  check_wall();
  check_refined_band();
  last_area_correction = 0.;
  // Newton's method: a shift by s changes the area by -s L.
  for (unsigned int i = 0; keep_area && i < 8; ++i)
  {
    const double excess = geometry.enclosed_volume() - area_0;
    if (geometry.measure() == 0.)
      throw SimulationError("The membrane has vanished: no cell of the mesh is cut by it any more.");
    if (std::abs(excess) < area_tolerance * area_0)
      break;
    if (std::abs(excess) > largest_area_error * area_0)
      throw SimulationError(
          "The enclosed area changes by more than 5 % in one time step: the step is too long.");
    const double shift = excess / geometry.measure();
    level_set.shift(shift);
    last_area_correction += shift;
    geometry.reinit(level_set.get_dof_handler(), level_set.values());
  }
  if (last_area_correction == 0.)
    return;
  if (std::abs(geometry.enclosed_volume() - area_0) > largest_remaining_area_error * area_0)
    throw SimulationError("The enclosed area cannot be made that of the beginning: the step is too long.");
  check_wall();
  check_refined_band();
}

template <int dim>
const MembranePointValues *CoupledSystem<dim>::compute_curvature()
{
  if (!bending)
    return nullptr;
  TimerOutput::Scope scope(timer_output, "surface: curvature");
  bending->compute_curvature(geometry, level_set.get_dof_handler(), level_set.values());
  return &bending->curvature();
}

template <int dim>
void CoupledSystem<dim>::solve_flow(const double time, const double dt,
                                    const CutCellVector<dim> *old_velocity)
{
  membrane_flow.solve(time, dt, {geometry, surface.get(), bending.get(), arclength_0}, old_velocity,
                      timer_output);
}

template <int dim>
void CoupledSystem<dim>::move_level_set(const MembraneMotion<dim> &motion)
{
  {
    TimerOutput::Scope scope(timer_output, "geometry: level set");
    level_set.advance(motion, BandLevelSet<dim>(current.band, origin, &current.cloud),
                      motion.old_membrane().distance_drift() > largest_distance_drift);
  }
  try
  {
    cut_mesh(true);
  }
  catch (const SimulationError &)
  {
    // Should a sign far from the membrane be wrong, it must not stay for the next try.
    level_set.forget_far_nodes();
    throw;
  }
}

template <int dim>
bool CoupledSystem<dim>::has_arclength_multiplier() const
{
  return parameters.arclength.model == Parameters::ArclengthModel::multiplier;
}

template <int dim>
double CoupledSystem<dim>::next_arclength() const
{
  const double arclength = std::accumulate(current.cloud.weights.begin(), current.cloud.weights.end(), 0.);
  const double largest_change = largest_arclength_change * arclength_0;
  return std::clamp(arclength_0, arclength - largest_change, arclength + largest_change);
}

template <int dim>
MembraneSnapshot<dim>
CoupledSystem<dim>::take_snapshot(const double time,
                                  const std::vector<TransportedFields<dim>> &transported) const
{
  const auto &cut_cells = geometry.cut_cells();
  std::vector<MembraneFields<dim>> fields(cut_cells.size());
  for (unsigned int c = 0; c < cut_cells.size(); ++c)
  {
    fields[c].velocity = raise_degree<dim>(get_flow().membrane_velocity()[c].nodal);
    fields[c].displacement = transported[c].displacement;
    fields[c].previous_velocity = transported[c].previous_velocity;
    if (has_arclength_multiplier())
      fields[c].tension_velocity = raise_degree<dim>(get_flow().tension_velocity()[c].nodal);
    if (surface)
    {
      fields[c].concentration = raise_degree<dim>(surface->concentration()[c]);
      fields[c].total_concentration = raise_degree<dim>(surface->total_concentration()[c]);
      fields[c].chemical_potential = raise_degree<dim>(surface->chemical_potential()[c]);
      fields[c].previous_concentration = transported[c].concentration;
      fields[c].preceding_concentration = transported[c].previous_concentration;
    }
  }
  MembraneSnapshot<dim> snapshot;
  snapshot.time = time;
  snapshot.origin = origin;
  snapshot.patches = gather_patches(cut_cells, fields, communicator);
  snapshot.band = level_set.gather_band();
  snapshot.cloud = gather_cloud(surface ? surface->cloud() : bare_cloud(geometry), communicator);
  return snapshot;
}

template <int dim>
StepErrors CoupledSystem<dim>::try_step(const double dt)
{
  const double time = current.time + dt;
  const bool first = dt_previous == 0.;
  const StepSizes steps{dt, dt_previous, dt_preceding};
  const BdfCoefficients bdf =
      first ? BdfCoefficients::first_order() : BdfCoefficients::second_order(dt / dt_previous);
  const MembraneProjection<dim> membrane(current.patches, origin);
  MembraneMotion<dim> motion(membrane, dt, dt_previous);
  dt_trial = dt;
  // Whether there is any is a property of the state, not of its history: a resumed run has to find the same.
  if (!model.bending().is_active())
    bending.reset();
  else if (!bending)
  {
    bending = std::make_unique<MembraneBending<dim>>(triangulation, model.bending());
    bending->reinit_mesh();
  }

  if (has_arclength_multiplier())
  {
    const double target = next_arclength();
    double aim = target;
    bool fits = motion.fit_measure(current.cloud, aim, area_0) == 0.;
    adapt_mesh(membrane, &motion);
    move_level_set(motion);
    // The length is predicted up to the error of the level set; where that is too large, aim differently.
    for (unsigned int i = 0; i < 3 && !fits; ++i)
    {
      const double excess = geometry.measure() - target;
      fits = std::abs(excess) < arclength_tolerance * arclength_0;
      if (!fits)
      {
        aim -= excess;
        motion.fit_measure(current.cloud, aim, area_0);
        move_level_set(motion);
      }
    }
  }
  else
  {
    adapt_mesh(membrane, &motion);
    move_level_set(motion);
  }
  const MembranePointValues *const curvature = compute_curvature();

  std::vector<TransportedFields<dim>> transported;
  CutCellScalar<dim> predicted;
  {
    TimerOutput::Scope scope(timer_output, "geometry: transported fields");
    transported = transport_fields(motion, geometry.cut_cells());
  }
  if (surface)
  {
    TimerOutput::Scope scope(timer_output, "surface: phases");
    const unsigned int n_cells = geometry.cut_cells().size();
    CutCellVector<dim> velocity(n_cells);
    for (unsigned int c = 0; c < n_cells; ++c)
      velocity[c] = transported[c].advecting_velocity;
    predicted = predict_concentration(transported, steps);

    SurfaceStep<dim> step;
    step.time_step = dt;
    step.bdf = bdf;
    step.clouds = {{&current.cloud, first ? nullptr : &previous.cloud}};
    step.velocity = &velocity;
    step.predicted_concentration = &predicted;
    step.curvature = curvature;
    std::array<CutCellScalar<dim>, 2> extended;
    CutCellScalar<dim> predicted_total;
    if (surface->needs_extended_fields())
    {
      using Fields = MembraneFields<dim>;
      extended[0] = extend_along_normals(membrane, &Fields::total_concentration, geometry.cut_cells());
      predicted_total = extended[0];
      step.extended_total_concentration[0] = &extended[0];
      if (!first)
      {
        const MembraneProjection<dim> previous_membrane(previous.patches, origin);
        extended[1] =
            extend_along_normals(previous_membrane, &Fields::total_concentration, geometry.cut_cells());
        for (unsigned int c = 0; c < n_cells; ++c)
          for (unsigned int i = 0; i < Fields::n; ++i)
            predicted_total[c][i] = bdf.e1 * extended[0][c][i] + bdf.e2 * extended[1][c][i];
        step.extended_total_concentration[1] = &extended[1];
      }
      step.predicted_total_concentration = &predicted_total;
    }
    surface->advance(geometry, level_set.get_dof_handler(), level_set.values(), step);
  }

  CutCellVector<dim> old_velocity(transported.size());
  for (unsigned int c = 0; c < transported.size(); ++c)
    old_velocity[c] = transported[c].previous_velocity;
  solve_flow(time, dt, &old_velocity);
  last_computed_time = time;
  trial_capillary_step = membrane_flow.capillary_time_step(geometry);
  trial = take_snapshot(time, transported);
  return estimate_step_errors(geometry, get_flow(), surface.get(), transported, predicted, steps,
                              communicator);
}

template <int dim>
void CoupledSystem<dim>::accept()
{
  ++n_steps_on_mesh;
  dt_preceding = dt_previous;
  dt_previous = dt_trial;
  previous = std::move(current);
  current = std::move(trial);
  current_capillary_step = trial_capillary_step;
  resist_negative_tension();
  sample_flow();
}

template <int dim>
void CoupledSystem<dim>::resist_negative_tension()
{
  const double cell_size = parameters.domain.cell_size(adaptation.limited(parameters.mesh.membrane_level));
  model.bending().resist_negative_tension(membrane_flow.smallest_tension(), cell_size);
}

template class CoupledSystem<2>;
template class CoupledSystem<3>;
} // namespace Gemmule
