#include <gemmule/application/initial_checks.h>
#include <gemmule/application/initial_membrane.h>
#include <gemmule/application/wall_cells.h>
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/mesh/box_mesh.h>
#include <gemmule/parameters/errors.h>
#include <gemmule/parameters/expression.h>
#include <gemmule/parameters/section.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // Criteria that depend on each other through the mesh settle in a few sweeps.
  constexpr unsigned int largest_number_of_sweeps = 12;

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
InitialMembrane<dim>::InitialMembrane(const AllParameters &parameters_, const MPI_Comm communicator_)
    : parameters(parameters_), communicator(communicator_),
      shape(make_function<dim>(parameters.membrane.level_set, 1, "Membrane/Level set", false))
{
  if (parameters.membrane.tension_model == Parameters::TensionModel::phase_field)
  {
    concentration = make_function<dim>(parameters.membrane.initial_concentration, 1,
                                       "Membrane/Initial concentration", false);
    total_concentration = make_function<dim>(parameters.membrane.initial_total_concentration, 1,
                                             "Membrane/Initial total concentration", false);
  }
  else
    prescribed_tension =
        make_function<dim>(parameters.membrane.prescribed_tension, 1, "Membrane/Prescribed tension");
}

template <int dim>
void InitialMembrane<dim>::find(Triangulation &triangulation) const
{
  const InitialChecks<dim> checks(parameters);
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
}

template <int dim>
void InitialMembrane<dim>::check_sign(const Triangulation &triangulation,
                                      const CutGeometry<dim> &geometry) const
{
  const WallCells count = count_wall_cells(triangulation, geometry, communicator);
  const InitialChecks<dim> checks(parameters);
  if (count.inside == count.all)
    checks.fail_level_set(
        "is negative along all walls of the box, but has to be positive outside the vesicle. "
        "Change its sign: -(" +
        parameters.membrane.level_set + ").");
}

template <int dim>
void InitialMembrane<dim>::check_wall(const Triangulation &triangulation, const CutGeometry<dim> &geometry,
                                      const unsigned int finest_level) const
{
  if (count_wall_cells(triangulation, geometry, communicator).not_outside == 0)
    return;
  const double edge = parameters.domain.cell_size(finest_level);
  InitialChecks<dim>(parameters)
      .fail_level_set(
          "describes a membrane that touches a wall of the box, comes closer to it than one of the finest "
          "cells "
          "(edge " +
          Parameters::to_text(edge) + " at level " + std::to_string(finest_level) +
          ", limited by 'Mesh/Finest level' and 'Mesh/Largest number of cells'), or leaves the box. "
          "Enlarge the box (Domain/Lower corner, Domain/Upper corner) or make the vesicle smaller.");
}

template <int dim>
void InitialMembrane<dim>::check_expressions(const std::vector<MembraneSample<dim>> &membrane) const
{
  std::vector<Point<dim>> points;
  for (const auto &sample : membrane)
    points.push_back(sample.point);
  if (prescribed_tension)
  {
    check_finite(*prescribed_tension, points, "Membrane/Prescribed tension");
    return;
  }
  InitialChecks<dim>(parameters).concentrations(*concentration, *total_concentration, points);
}

template <int dim>
std::vector<MembraneSample<dim>> InitialMembrane<dim>::samples(const Point<dim> &origin,
                                                               const CutGeometry<dim> &geometry) const
{
  const auto patches = gather_bare_patches(geometry, communicator);
  const MembraneProjection<dim> membrane = InitialChecks<dim>(parameters).project(patches, origin);
  std::vector<MembraneSample<dim>> result;
  for (const auto &s : membrane.samples())
  {
    MembraneSample<dim> sample;
    sample.point = s.point;
    sample.normal = s.normal;
    sample.curvature = membrane.curvature(s);
    if (concentration)
      sample.composition = concentration->value(s.point) / total_concentration->value(s.point);
    result.push_back(sample);
  }
  return result;
}

template <int dim>
void InitialMembrane<dim>::make_mesh(Triangulation &triangulation, LevelSet<dim> &level_set,
                                     CutGeometry<dim> &geometry, MeshAdaptation<dim> &adaptation,
                                     const std::vector<CellSample<dim>> &cells) const
{
  const auto cut_mesh = [&]
  {
    level_set.reinit_mesh();
    level_set.interpolate(*shape);
    geometry.reinit(level_set.get_dof_handler(), level_set.values());
  };
  find(triangulation);
  cut_mesh();
  // Before the criteria refine towards the wall what is wrong anyway.
  check_sign(triangulation, geometry);
  InitialChecks<dim>(parameters).walls(*shape);
  for (unsigned int sweep = 0; sweep < largest_number_of_sweeps; ++sweep)
  {
    const auto membrane = samples(lower_corner<dim>(parameters.domain), geometry);
    check_expressions(membrane);
    if (!adaptation.adapt(membrane, cells))
      break;
    cut_mesh();
  }
  check_wall(triangulation, geometry, adaptation.limited(parameters.mesh.largest_level()));
}

template <int dim>
bool InitialMembrane<dim>::refine_mesh(const Point<dim> &origin, Triangulation &triangulation,
                                       LevelSet<dim> &level_set, CutGeometry<dim> &geometry,
                                       MeshAdaptation<dim> &adaptation,
                                       const std::vector<CellSample<dim>> &cells) const
{
  if (!adaptation.adapt(samples(origin, geometry), cells))
    return false;
  make_mesh(triangulation, level_set, geometry, adaptation, cells);
  return true;
}

template <int dim>
void InitialMembrane<dim>::make_level_set(const Point<dim> &origin, LevelSet<dim> &level_set,
                                          CutGeometry<dim> &geometry) const
{
  level_set.interpolate(*shape);
  geometry.reinit(level_set.get_dof_handler(), level_set.values());
  const auto patches = gather_bare_patches(geometry, communicator);
  const InitialChecks<dim> checks(parameters);
  const MembraneProjection<dim> membrane = checks.project(patches, origin);
  checks.membrane(*shape, membrane);
  const double area = geometry.enclosed_volume(), arclength = geometry.measure();
  level_set.set_distance(membrane);
  geometry.reinit(level_set.get_dof_handler(), level_set.values());
  checks.distance(area, geometry.enclosed_volume(), arclength, geometry.measure());
}

template <int dim>
void InitialMembrane<dim>::make_phases(const LevelSet<dim> &level_set, const CutGeometry<dim> &geometry,
                                       SurfaceSolver<dim> &surface,
                                       const MembranePointValues *const curvature) const
{
  surface.initialise(geometry, level_set.get_dof_handler(), level_set.values(), *concentration,
                     *total_concentration, curvature);
}

template class InitialMembrane<2>;
template class InitialMembrane<3>;
} // namespace Gemmule
