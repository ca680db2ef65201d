#include <gemmule/algebra/gather.h>
#include <gemmule/application/coupled_system.h>
#include <gemmule/application/initial_checks.h>
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/mesh/box_mesh.h>
#include <gemmule/parameters/errors.h>
#include <gemmule/parameters/expression.h>

#include <cmath>
#include <limits>

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

  /** @throws ParameterError where the function is not finite */
  template <int dim>
  bool lattice_sign_change(const Function<dim> &function, const Point<dim> &corner, const double h)
  {
    constexpr unsigned int n = 8;
    bool negative = false, positive = false;
    const unsigned int n_points = dim == 2 ? (n + 1) * (n + 1) : (n + 1) * (n + 1) * (n + 1);
    for (unsigned int i = 0; i < n_points; ++i)
    {
      Point<dim> p = corner;
      for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n + 1)
        p[d] += h * (rest % (n + 1)) / n;
      const double value = function.value(p);
      if (!std::isfinite(value))
        check_finite(function, {p}, "Membrane/Level set");
      (value < 0. ? negative : positive) = true;
    }
    return negative && positive;
  }
} // namespace

template <int dim>
CoupledSystem<dim>::CoupledSystem(const AllParameters &parameters_, const MPI_Comm communicator_)
    : parameters(parameters_), communicator(communicator_),
      triangulation(communicator, dealii::Triangulation<dim>::MeshSmoothing::none),
      origin(
          [this]
          {
            make_box_mesh(triangulation, parameters.domain, parameters.mesh.bulk_level);
            return lower_corner<dim>(parameters.domain);
          }()),
      // Without the communicator: with it, every exception would be preceded by a banner on the screen.
      timer_output(std::cout, TimerOutput::never, TimerOutput::cpu_and_wall_times),
      boundary_velocity(
          make_function<dim>(parameters.domain.boundary_velocity, dim, "Domain/Boundary velocity")),
      prescribed_tension(
          make_function<dim>(parameters.membrane.prescribed_tension, 1, "Membrane/Prescribed tension")),
      model(parameters.membrane, parameters.regularisation), level_set(triangulation),
      flow(triangulation, parameters.fluid, parameters.flow), adaptation(triangulation, parameters.mesh)
{
  if (parameters.membrane.tension_model == Parameters::TensionModel::phase_field)
    surface = std::make_unique<SurfaceSolver<dim>>(triangulation, model, parameters.surface);
}

template <int dim>
void CoupledSystem<dim>::reinit_mesh()
{
  TimerOutput::Scope scope(timer_output, "mesh: degrees of freedom");
  level_set.reinit_mesh();
  if (surface)
    surface->reinit_mesh();
  flow.reinit_mesh();
  steps_since_remeshing = 0;
}

template <int dim>
void CoupledSystem<dim>::make_initial_mesh()
{
  const auto shape = make_function<dim>(parameters.membrane.level_set, 1, "Membrane/Level set");
  const auto concentration =
      make_function<dim>(parameters.membrane.initial_concentration, 1, "Membrane/Initial concentration");
  const auto total_concentration = make_function<dim>(parameters.membrane.initial_total_concentration, 1,
                                                      "Membrane/Initial total concentration");

  const InitialChecks<dim> checks(parameters);

  // Towards the membrane as the expression has it, until it is resolved.
  for (unsigned int level = parameters.mesh.bulk_level; level <= parameters.mesh.membrane_level; ++level)
  {
    unsigned int n_crossed = 0, n_negative = 0;
    std::string not_finite;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned() && not_finite.empty())
      {
        if (shape->value(cell->center()) < 0.)
          ++n_negative;
        try
        {
          if (!lattice_sign_change(*shape, cell->vertex(0), cell->extent_in_direction(0)))
            continue;
        }
        catch (const ParameterError &error)
        {
          not_finite = error.complaint;
          continue;
        }
        ++n_crossed;
        if (cell->level() < static_cast<int>(parameters.mesh.membrane_level))
          cell->set_refine_flag();
      }
    checks.level_set(n_crossed, n_negative, not_finite, communicator);
    triangulation.execute_coarsening_and_refinement();
    checks.number_of_cells(triangulation.n_global_active_cells(),
                           std::min(level + 1, parameters.mesh.membrane_level));
  }

  // Then as the criteria want it, with the initial composition.
  for (unsigned int sweep = 0; sweep < 12; ++sweep)
  {
    level_set.reinit_mesh();
    level_set.interpolate(*shape);
    geometry.reinit(level_set.get_dof_handler(), level_set.values());
    check_initial_wall();
    const auto patches = gather_patches(
        geometry.cut_cells(), std::vector<MembraneFields<dim>>(geometry.cut_cells().size()), communicator);
    const MembraneProjection<dim> membrane = checks.project(patches, origin);
    std::vector<MembraneSample<dim>> wanted;
    std::vector<Point<dim>> points;
    for (const auto &s : membrane.samples())
    {
      MembraneSample<dim> sample;
      sample.point = s.point;
      sample.curvature = membrane.curvature(s);
      if (surface)
        sample.composition = concentration->value(s.point) / total_concentration->value(s.point);
      wanted.push_back(sample);
      points.push_back(s.point);
    }
    if (surface)
      checks.concentrations(*concentration, *total_concentration, points);
    else
      check_finite(*prescribed_tension, points, "Membrane/Prescribed tension");
    if (!adaptation.adapt(wanted))
      break;
  }

  reinit_mesh();
  level_set.interpolate(*shape);
  geometry.reinit(level_set.get_dof_handler(), level_set.values());
  const auto patches = gather_patches(
      geometry.cut_cells(), std::vector<MembraneFields<dim>>(geometry.cut_cells().size()), communicator);
  const MembraneProjection<dim> membrane = checks.project(patches, origin);
  checks.membrane(*shape, membrane);
  const double area = geometry.enclosed_volume(), arclength = geometry.measure();
  level_set.set_distance(membrane);
  geometry.reinit(level_set.get_dof_handler(), level_set.values());
  checks.distance(area, geometry.enclosed_volume(), arclength, geometry.measure());
  if (surface)
    surface->initialise(geometry, level_set.get_dof_handler(), level_set.values(), *concentration,
                        *total_concentration);
}

template <int dim>
void CoupledSystem<dim>::initialise()
{
  make_initial_mesh();
  area_0 = geometry.enclosed_volume();
  arclength_0 = parameters.arclength.reference_arclength > 0. ? parameters.arclength.reference_arclength
                                                              : geometry.measure();
  solve_flow(0., parameters.time_stepping.initial_step, nullptr);

  std::vector<TransportedFields<dim>> at_rest(geometry.cut_cells().size());
  for (unsigned int c = 0; c < at_rest.size(); ++c)
    for (unsigned int i = 0; i < MembraneFields<dim>::n; ++i)
      at_rest[c].previous_velocity[i] = raise_degree<dim>(flow.membrane_velocity()[c].nodal)[i];
  InitialChecks<dim>(parameters).flow(flow.max_velocity());
  current = take_snapshot(0., at_rest);
  current_capillary_step = compute_capillary_time_step();
}

template <int dim>
typename CoupledSystem<dim>::WallCells CoupledSystem<dim>::count_wall_cells() const
{
  WallCells count;
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && cell->at_boundary())
    {
      ++count.all;
      // Cut cells count as well: the flow needs whole cells of the outer fluid where the velocity is
      // prescribed.
      count.not_outside += geometry.is_active(cell->active_cell_index(), 0);
      count.inside += geometry.location(cell->active_cell_index()) == CellLocation::inside;
    }
  count.all = Utilities::MPI::sum(count.all, communicator);
  count.not_outside = Utilities::MPI::sum(count.not_outside, communicator);
  count.inside = Utilities::MPI::sum(count.inside, communicator);
  return count;
}

template <int dim>
void CoupledSystem<dim>::check_initial_wall() const
{
  const WallCells count = count_wall_cells();
  const InitialChecks<dim> checks(parameters);
  if (count.inside == count.all)
    checks.fail_level_set(
        "is negative along all walls of the box, but has to be positive outside the vesicle. "
        "Change its sign: -(" +
        parameters.membrane.level_set + ").");
  if (count.not_outside > 0)
    checks.fail_level_set(
        "describes a membrane that touches a wall of the box, comes closer to it than one cell, or leaves "
        "the box. Enlarge the box (Domain/Lower corner, Domain/Upper corner) or make the vesicle smaller.");
}

template <int dim>
void CoupledSystem<dim>::check_wall() const
{
  if (count_wall_cells().not_outside > 0)
    throw SimulationError("The membrane has reached the wall of the box. Use a larger box, or end earlier.");
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
      changed = adaptation.adapt(wanted);
      steps_since_remeshing = 0;
    }
  }
  if (changed)
    reinit_mesh();
}

template <int dim>
void CoupledSystem<dim>::cut_mesh(const bool keep_area)
{
  TimerOutput::Scope scope(timer_output, "geometry: cut cells");
  geometry.reinit(level_set.get_dof_handler(), level_set.values());
  check_wall();
  last_area_correction = 0.;
  // Newton's method: a shift by s changes the area by -s L.
  for (unsigned int i = 0; keep_area && i < 3; ++i)
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
}

template <int dim>
void CoupledSystem<dim>::solve_flow(const double time, const double dt,
                                    const CutCellVector<dim> *old_velocity)
{
  if (surface)
    total_tension = surface->tension();
  else
  {
    prescribed_tension->set_time(time);
    total_tension.resize(geometry.cut_cells().size());
    for (unsigned int c = 0; c < total_tension.size(); ++c)
    {
      const auto &cell = geometry.cut_cells()[c];
      total_tension[c].resize(cell.surface_points.size());
      for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
        total_tension[c][q] = prescribed_tension->value(cell.physical(cell.surface_points[q]));
    }
  }
  boundary_velocity->set_time(time);
  const MembraneScalar tension_of_membrane = total_tension;
  MembraneScalar dilatational_modulus(surface ? total_tension.size() : 0);
  for (unsigned int c = 0; c < dilatational_modulus.size(); ++c)
    for (const auto &q : geometry.cut_cells()[c].surface_points)
      dilatational_modulus[c].push_back(
          model.dilatational_modulus(TensorLagrange<dim, 2>::value(surface->total_concentration()[c], q)));
  const SemiImplicitTension<dim> semi_implicit{parameters.time_stepping.tension_implicitness * dt,
                                               &tension_of_membrane,
                                               surface ? &dilatational_modulus : nullptr, old_velocity};
  {
    TimerOutput::Scope scope(timer_output, "flow: assembly and factorisation");
    flow.prepare(geometry, *boundary_velocity,
                 old_velocity != nullptr && semi_implicit.coefficient > 0. ? &semi_implicit : nullptr);
  }
  TimerOutput::Scope scope(timer_output, "flow: solution");
  if (parameters.arclength.model == Parameters::ArclengthModel::penalty)
  {
    const ArclengthPenalty penalty{parameters.arclength.penalty, geometry.measure() - arclength_0, dt};
    flow.solve(total_tension, &penalty);
    for (auto &cell : total_tension)
      for (double &sigma : cell)
        sigma += flow.constraint_tension();
  }
  else
    flow.solve(total_tension);
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
    fields[c].velocity = raise_degree<dim>(flow.membrane_velocity()[c].nodal);
    fields[c].displacement = transported[c].displacement;
    fields[c].previous_velocity = transported[c].previous_velocity;
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
  if (surface)
    snapshot.cloud = gather_cloud(surface->cloud(), communicator);
  return snapshot;
}

template <int dim>
typename CoupledSystem<dim>::StepErrors CoupledSystem<dim>::try_step(const double dt)
{
  const double time = current.time + dt;
  const bool first = dt_previous == 0.;
  const BdfCoefficients bdf =
      first ? BdfCoefficients::first_order() : BdfCoefficients::second_order(dt / dt_previous);
  const MembraneProjection<dim> membrane(current.patches, origin);
  const MembraneMotion<dim> motion(membrane, dt, dt_previous);
  dt_trial = dt;

  adapt_mesh(membrane, &motion);
  {
    TimerOutput::Scope scope(timer_output, "geometry: level set");
    level_set.advance(motion, BandLevelSet<dim>(current.band, origin),
                      membrane.distance_drift() > largest_distance_drift);
  }
  cut_mesh(true);

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
    // quadratic extrapolation along the trajectories as soon as there are three levels, else what there is
    const bool three_levels = dt_preceding > 0.;
    const double t1 = -dt_previous, t2 = -dt_previous - dt_preceding;
    CutCellVector<dim> velocity(n_cells);
    predicted.resize(n_cells);
    for (unsigned int c = 0; c < n_cells; ++c)
    {
      velocity[c] = transported[c].advecting_velocity;
      for (unsigned int i = 0; i < MembraneFields<dim>::n; ++i)
      {
        const double f0 = transported[c].concentration[i], f1 = transported[c].previous_concentration[i],
                     f2 = transported[c].preceding_concentration[i];
        predicted[c][i] = three_levels ? f0 * (dt - t1) * (dt - t2) / (t1 * t2) +
                                             f1 * dt * (dt - t2) / (t1 * (t1 - t2)) +
                                             f2 * dt * (dt - t1) / (t2 * (t2 - t1))
                                       : bdf.e1 * f0 + (first ? 0. : bdf.e2 * f1);
      }
    }

    SurfaceStep<dim> step;
    step.time_step = dt;
    step.bdf = bdf;
    step.clouds = {{&current.cloud, first ? nullptr : &previous.cloud}};
    step.velocity = &velocity;
    step.predicted_concentration = &predicted;
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
  trial_capillary_step = compute_capillary_time_step();
  trial = take_snapshot(time, transported);
  return estimate_errors(dt, transported, predicted);
}

template <int dim>
typename CoupledSystem<dim>::StepErrors
CoupledSystem<dim>::estimate_errors(const double dt, const std::vector<TransportedFields<dim>> &transported,
                                    const CutCellScalar<dim> &predicted_concentration) const
{
  // Position: BDF2 with the velocity that came out instead of the extrapolated one differs by dt/a0 (u - u*),
  // which is the leading part of the local error. Concentration: Milne's device on the quadratic predictor
  // and BDF2, whose local errors are dt (dt + dt1)(dt + dt1 + dt2)/6 and dt^2 (dt + dt1)^2 / (6 (2 dt + dt1))
  // times f'''.
  const double dt1 = dt_previous, dt2 = dt_preceding;
  const double a0 = dt1 > 0. ? (dt1 + 2. * dt) / (dt1 + dt) : 1.;
  double milne = 0.;
  if (dt2 > 0.)
  {
    const double predictor = (dt + dt1) * (dt + dt1 + dt2),
                 corrector = dt * (dt + dt1) * (dt + dt1) / (2. * dt + dt1);
    milne = corrector / (predictor + corrector);
  }
  StepErrors errors;
  bool finite = true;
  for (unsigned int c = 0; c < geometry.cut_cells().size(); ++c)
  {
    const auto &cell = geometry.cut_cells()[c];
    for (const auto &q : cell.surface_points)
    {
      const Tensor<1, dim> u = flow.membrane_velocity()[c].value(q);
      const Tensor<1, dim> extrapolated = TensorLagrange<dim, 3>::value(transported[c].advecting_velocity, q);
      const double shape_error = dt / a0 * (u - extrapolated).norm();
      finite = finite && std::isfinite(shape_error);
      errors.shape = std::max(errors.shape, shape_error);
      if (surface)
      {
        const double f = TensorLagrange<dim, 2>::value(surface->concentration()[c], q);
        finite = finite && std::isfinite(f);
        if (milne > 0.)
          errors.composition =
              std::max(errors.composition,
                       milne * std::abs(f - TensorLagrange<dim, 3>::value(predicted_concentration[c], q)));
      }
    }
  }
  if (Utilities::MPI::min(static_cast<unsigned int>(finite), communicator) == 0)
    throw SimulationError("the solution is not a finite number.");
  errors.shape = Utilities::MPI::max(errors.shape, communicator);
  errors.composition = Utilities::MPI::max(errors.composition, communicator);
  return errors;
}

template <int dim>
void CoupledSystem<dim>::accept()
{
  dt_preceding = dt_previous;
  dt_previous = dt_trial;
  previous = std::move(current);
  current = std::move(trial);
  current_capillary_step = trial_capillary_step;
}

template <int dim>
double CoupledSystem<dim>::compute_capillary_time_step() const
{
  double local = std::numeric_limits<double>::max();
  for (unsigned int c = 0; c < geometry.cut_cells().size(); ++c)
    for (const double sigma : total_tension[c])
      local = std::min(local, geometry.cut_cells()[c].size / std::max(std::abs(sigma), 1e-12));
  return parameters.fluid.capillary_number * Utilities::MPI::min(local, communicator);
}

template class CoupledSystem<2>;
template class CoupledSystem<3>;
} // namespace Gemmule
