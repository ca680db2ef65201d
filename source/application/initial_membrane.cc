#include <gemmule/application/initial_membrane.h>
#include <gemmule/application/wall_cells.h>
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/mesh/box_mesh.h>
#include <gemmule/parameters/errors.h>
#include <gemmule/parameters/expression.h>

#include <sstream>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // Criteria that depend on each other through the mesh settle in a few sweeps.
  constexpr unsigned int largest_number_of_sweeps = 12;

  template <int dim>
  std::string coordinates(const Point<dim> &p)
  {
    std::ostringstream text;
    text.precision(3);
    for (unsigned int d = 0; d < dim; ++d)
      text << (d == 0 ? "" : ", ") << p[d];
    return text.str();
  }

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
      (function.value(p) < 0. ? negative : positive) = true;
    }
    return negative && positive;
  }

  /** The membrane without fields on it. */
  template <int dim>
  std::vector<MembranePatch<dim>> bare_patches(const CutGeometry<dim> &geometry, const MPI_Comm communicator)
  {
    return gather_patches(geometry.cut_cells(), std::vector<MembraneFields<dim>>(geometry.cut_cells().size()),
                          communicator);
  }
} // namespace

template <int dim>
InitialMembrane<dim>::InitialMembrane(const AllParameters &parameters_, const MPI_Comm communicator_)
    : parameters(parameters_), communicator(communicator_),
      shape(make_function<dim>(parameters.membrane.level_set, 1, "Membrane/Level set"))
{
  if (parameters.membrane.tension_model == Parameters::TensionModel::phase_field)
  {
    concentration =
        make_function<dim>(parameters.membrane.initial_concentration, 1, "Membrane/Initial concentration");
    total_concentration = make_function<dim>(parameters.membrane.initial_total_concentration, 1,
                                             "Membrane/Initial total concentration");
  }
  else
    prescribed_tension =
        make_function<dim>(parameters.membrane.prescribed_tension, 1, "Membrane/Prescribed tension");
}

template <int dim>
void InitialMembrane<dim>::find(Triangulation &triangulation) const
{
  for (unsigned int level = parameters.mesh.bulk_level; level <= parameters.mesh.membrane_level; ++level)
  {
    unsigned int n_crossed = 0, n_inside = 0;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        if (shape->value(cell->center()) < 0.)
          ++n_inside;
        if (lattice_sign_change(*shape, cell->vertex(0), cell->extent_in_direction(0)))
        {
          ++n_crossed;
          if (cell->level() < static_cast<int>(parameters.mesh.membrane_level))
            cell->set_refine_flag();
        }
      }
    if (Utilities::MPI::sum(n_crossed, communicator) == 0)
      throw UserError(
          "Membrane/Level set: '" + parameters.membrane.level_set + "' has no zero in the box: it is " +
          (Utilities::MPI::sum(n_inside, communicator) > 0 ? "negative" : "positive") +
          " everywhere. Give a function that is negative inside the vesicle and positive outside, "
          "for example x^2+2*y^2-0.25, or a finer 'Mesh/Bulk level' if the vesicle is tiny.");
    triangulation.execute_coarsening_and_refinement();
  }
}

template <int dim>
void InitialMembrane<dim>::check_wall(const Triangulation &triangulation,
                                      const CutGeometry<dim> &geometry) const
{
  const WallCells count = count_wall_cells(triangulation, geometry, communicator);
  const std::string expression = "Membrane/Level set: '" + parameters.membrane.level_set + "' ";
  if (count.inside == count.all)
    throw UserError(expression +
                    "is negative along all walls of the box, but has to be positive outside the vesicle. "
                    "Change its sign: -(" +
                    parameters.membrane.level_set + ").");
  if (count.not_outside > 0)
    throw UserError(
        expression +
        "describes a membrane that touches a wall of the box, comes closer to it than one cell, or leaves "
        "the box. Enlarge the box (Domain/Lower corner, Domain/Upper corner) or make the vesicle smaller.");
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
  check_finite(*concentration, points, "Membrane/Initial concentration");
  check_finite(*total_concentration, points, "Membrane/Initial total concentration");
  for (const auto &p : points)
    if (total_concentration->value(p) <= 0.)
      throw ParameterError("Membrane/Initial total concentration",
                           "'" + parameters.membrane.initial_total_concentration + "' is not positive at (" +
                               coordinates(p) +
                               ") on the membrane. Give an expression that is positive there.");
}

template <int dim>
std::vector<MembraneSample<dim>> InitialMembrane<dim>::samples(const Point<dim> &origin,
                                                               const CutGeometry<dim> &geometry) const
{
  const auto patches = bare_patches(geometry, communicator);
  const MembraneProjection<dim> membrane(patches, origin);
  std::vector<MembraneSample<dim>> result;
  for (const auto &s : membrane.samples())
  {
    MembraneSample<dim> sample;
    sample.point = s.point;
    sample.curvature = membrane.curvature(s);
    if (concentration)
      sample.composition = concentration->value(s.point) / total_concentration->value(s.point);
    result.push_back(sample);
  }
  return result;
}

template <int dim>
void InitialMembrane<dim>::make_mesh(Triangulation &triangulation, LevelSet<dim> &level_set,
                                     CutGeometry<dim> &geometry, MeshAdaptation<dim> &adaptation) const
{
  find(triangulation);
  for (unsigned int sweep = 0; sweep < largest_number_of_sweeps; ++sweep)
  {
    level_set.reinit_mesh();
    level_set.interpolate(*shape);
    geometry.reinit(level_set.get_dof_handler(), level_set.values());
    check_wall(triangulation, geometry);
    const auto membrane = samples(lower_corner<dim>(parameters.domain), geometry);
    check_expressions(membrane);
    if (!adaptation.adapt(membrane))
      break;
  }
}

template <int dim>
void InitialMembrane<dim>::make_level_set(const Point<dim> &origin, LevelSet<dim> &level_set,
                                          CutGeometry<dim> &geometry) const
{
  level_set.interpolate(*shape);
  geometry.reinit(level_set.get_dof_handler(), level_set.values());
  const auto patches = bare_patches(geometry, communicator);
  level_set.set_distance(MembraneProjection<dim>(patches, origin));
  geometry.reinit(level_set.get_dof_handler(), level_set.values());
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
