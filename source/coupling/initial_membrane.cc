// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/coupling/initial_checks.h>
#include <gemmule/coupling/initial_membrane.h>
#include <gemmule/coupling/wall_cells.h>
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/mesh/box_mesh.h>
#include <gemmule/parameters/expression.h>
#include <gemmule/parameters/expression_bounds.h>
#include <gemmule/parameters/section.h>

#include <unordered_set>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // Criteria that depend on each other through the mesh settle in a few sweeps.
  constexpr unsigned int largest_number_of_sweeps = 12;
  // How far the membrane may lie beside that of the cut cells, in edges of the cell.
  constexpr double largest_offset = 0.1;
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
void InitialMembrane<dim>::find(const Triangulation &triangulation)
{
  const BoxLattice<dim> box(triangulation);
  const auto &mesh = parameters.mesh;
  std::vector<LatticeKey<dim>> cubes;
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned())
      cubes.push_back(box.position_of_corner(cell->vertex(0), mesh.bulk_level));

  const ExpressionBounds<dim> bounds(*expression_tree<dim>(parameters.membrane.level_set));
  const MembraneSearch<dim> search(
      *shape, [&](const Point<dim> &corner, const double size) { return bounds.on_cube(corner, size); }, box,
      {mesh.bulk_level, mesh.membrane_level, mesh.largest_level()}, mesh.largest_number_of_cells);
  const FoundMembrane<dim> found = search.search(std::move(cubes), communicator);
  InitialChecks<dim>(parameters).found(found, shape->value(box.lower) < 0., communicator);

  if (found.blind_size > 0.)
    search_warnings.push_back(
        "'Membrane/Level set' has so many waves that its zeros were looked for at points " +
        Parameters::to_text(found.blind_size) +
        " apart: closed parts of the membrane that are smaller may have been missed. Give a "
        "simpler expression, or a coarser 'Mesh/Finest level'.");
  roots = found.roots;
  std::vector<typename ZeroSetDistance<dim>::KnownPoint> points;
  for (const auto &root : roots)
    points.push_back({root.point(), root.spacing});
  distance = std::make_unique<ZeroSetDistance<dim>>(*shape, points);
}

template <int dim>
void InitialMembrane<dim>::refine_towards_membrane(Triangulation &triangulation) const
{
  const BoxLattice<dim> box(triangulation);
  const unsigned int membrane_level = parameters.mesh.membrane_level;
  // The cells that have to be refined: all that hold a root and are larger than those of the membrane.
  std::vector<std::unordered_set<LatticeKey<dim>, LatticeKeyHash<dim>>> too_large(membrane_level);
  for (const auto &root : roots)
    for (unsigned int level = parameters.mesh.bulk_level; level < membrane_level; ++level)
      too_large[level].insert(box.position_of(root.point(), level));

  const InitialChecks<dim> checks(parameters);
  for (unsigned int level = parameters.mesh.bulk_level; level < membrane_level; ++level)
  {
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned() && cell->level() < static_cast<int>(membrane_level) &&
          too_large[cell->level()].count(box.position_of_corner(cell->vertex(0), cell->level())) > 0)
        cell->set_refine_flag();
    triangulation.execute_coarsening_and_refinement();
    checks.number_of_cells(triangulation.n_global_active_cells(), level + 1);
  }
}

template <int dim>
void InitialMembrane<dim>::cut_mesh(LevelSet<dim> &level_set, CutGeometry<dim> &geometry) const
{
  level_set.interpolate(*distance);
  geometry.reinit(level_set.get_dof_handler(), level_set.values());
}

template <int dim>
bool InitialMembrane<dim>::refine_lost_parts(Triangulation &triangulation, const LevelSet<dim> &level_set,
                                             const CutGeometry<dim> &geometry) const
{
  const BoxLattice<dim> box(triangulation);
  const unsigned int finest_level = parameters.mesh.largest_level();
  const auto lost = find_lost_parts(level_set, geometry, *distance, roots, communicator);
  InitialChecks<dim>(parameters).number_of_details(lost);
  std::vector<std::unordered_set<LatticeKey<dim>, LatticeKeyHash<dim>>> too_large(finest_level);
  for (const auto &part : lost)
    if (part.level < finest_level)
      too_large[part.level].insert(part.cell);
  unsigned int n_refined = 0;
  for (const auto &cell : triangulation.active_cell_iterators())
    if (cell->is_locally_owned() && cell->level() < static_cast<int>(finest_level) &&
        too_large[cell->level()].count(box.position_of_corner(cell->vertex(0), cell->level())) > 0)
    {
      cell->set_refine_flag();
      ++n_refined;
    }
  if (Utilities::MPI::sum(n_refined, communicator) == 0)
    return false;
  triangulation.execute_coarsening_and_refinement();
  return true;
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
  refine_towards_membrane(triangulation);
  level_set.reinit_mesh();
  cut_mesh(level_set, geometry);
  while (refine_lost_parts(triangulation, level_set, geometry))
  {
    level_set.reinit_mesh();
    cut_mesh(level_set, geometry);
  }
  // Before the criteria refine towards the wall what is wrong anyway.
  check_sign(triangulation, geometry);
  InitialChecks<dim>(parameters).walls(*shape);
  for (unsigned int sweep = 0; sweep < largest_number_of_sweeps; ++sweep)
  {
    const auto membrane = samples(lower_corner<dim>(parameters.domain), geometry);
    check_expressions(membrane);
    if (!adaptation.adapt(membrane, cells))
      break;
    level_set.reinit_mesh();
    cut_mesh(level_set, geometry);
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
  cut_mesh(level_set, geometry);
  const InitialChecks<dim> checks(parameters);
  checks.nothing_lost(find_lost_parts(level_set, geometry, *distance, roots, communicator));
  const auto patches = gather_bare_patches(geometry, communicator);
  const MembraneProjection<dim> membrane = checks.project(patches, origin);
  checks.membrane(*distance, membrane);
  const double area = geometry.enclosed_volume(), arclength = geometry.measure();
  // The cut cells have the membrane up to an error of interpolation, the expression has it exactly.
  level_set.set_distance(membrane,
                         [&](const ClosestPoint<dim> &closest) {
                           return distance->offset(closest.point, closest.normal,
                                                   largest_offset * patches[closest.patch].size);
                         });
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
