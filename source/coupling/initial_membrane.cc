// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
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
InitialMembrane<dim>::InitialMembrane(const AllParameters &parameters_, Triangulation &triangulation,
                                      Interface<dim> &interface, MeshAdaptation<dim> &adaptation)
    : parameters(parameters_), communicator(triangulation.get_communicator()), triangulation(triangulation),
      interface(interface), adaptation(adaptation), checks(parameters),
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
void InitialMembrane<dim>::find()
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
  checks.found(found, shape->value(box.lower) < 0., communicator);

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
void InitialMembrane<dim>::refine_towards_membrane()
{
  const BoxLattice<dim> box(triangulation);
  const unsigned int membrane_level = parameters.mesh.membrane_level;
  // The cells that have to be refined: all that hold a root and are larger than those of the membrane.
  std::vector<std::unordered_set<LatticeKey<dim>, LatticeKeyHash<dim>>> too_large(membrane_level);
  for (const auto &root : roots)
    for (unsigned int level = parameters.mesh.bulk_level; level < membrane_level; ++level)
      too_large[level].insert(box.position_of(root.point(), level));

  for (unsigned int level = parameters.mesh.bulk_level; level < membrane_level; ++level)
  {
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned() && cell->level() < static_cast<int>(membrane_level) &&
          too_large[cell->level()].count(box.position_of_corner(cell->vertex(0), cell->level())) > 0)
        cell->set_refine_flag();
    triangulation.execute_coarsening_and_refinement();
    checks.number_of_cells(triangulation.n_global_active_cells(), level + 1);
  }
  adaptation.load_balance().divide();
}

template <int dim>
void InitialMembrane<dim>::cut_mesh()
{
  interface.reinit_mesh();
  interface.interpolate(*distance);
  interface.cut();
  gather_patches();
}

template <int dim>
void InitialMembrane<dim>::gather_patches()
{
  projection.reset();
  patches = gather_bare_patches(interface.geometry(), communicator);
  try
  {
    projection = std::make_unique<MembraneProjection<dim>>(patches, parameters.domain.lower<dim>());
  }
  catch (const SimulationError &)
  {
    // No patch has a point of the membrane, on all ranks.
  }
}

template <int dim>
std::vector<LostPart<dim>> InitialMembrane<dim>::lost_parts() const
{
  return find_lost_parts(interface, projection.get(), *distance, roots, communicator);
}

template <int dim>
bool InitialMembrane<dim>::refine_lost_parts()
{
  const BoxLattice<dim> box(triangulation);
  const unsigned int finest_level = parameters.mesh.largest_level();
  const auto lost = lost_parts();
  checks.number_of_details(lost);
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
  adaptation.load_balance().divide();
  return true;
}

template <int dim>
void InitialMembrane<dim>::check_sign() const
{
  const WallCells count = count_wall_cells(triangulation, interface.geometry(), communicator);
  if (count.inside == count.all)
    checks.fail_level_set(
        "is negative along all walls of the box, but has to be positive outside the vesicle. "
        "Change its sign: -(" +
        parameters.membrane.level_set + ").");
}

template <int dim>
void InitialMembrane<dim>::check_wall(const unsigned int finest_level) const
{
  if (count_wall_cells(triangulation, interface.geometry(), communicator).not_outside == 0)
    return;
  const double edge = parameters.domain.cell_size(finest_level);
  checks.fail_level_set(
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
  checks.concentrations(*concentration, *total_concentration, points);
}

template <int dim>
std::vector<MembraneSample<dim>> InitialMembrane<dim>::samples() const
{
  checks.on_mesh(projection.get());
  std::vector<MembraneSample<dim>> result;
  for (const auto &s : projection->samples())
  {
    MembraneSample<dim> sample;
    sample.point = s.point;
    sample.normal = s.normal;
    sample.curvature = projection->curvature(s);
    if (concentration)
      sample.composition = concentration->value(s.point) / total_concentration->value(s.point);
    result.push_back(sample);
  }
  return result;
}

template <int dim>
void InitialMembrane<dim>::make_mesh(const std::vector<CellSample<dim>> &cells)
{
  refine_towards_membrane();
  do
    cut_mesh();
  while (refine_lost_parts());
  // Before the criteria refine towards the wall what is wrong anyway.
  check_sign();
  checks.walls(*shape);
  for (unsigned int sweep = 0; sweep < largest_number_of_sweeps; ++sweep)
  {
    const auto membrane = samples();
    check_expressions(membrane);
    if (!adaptation.adapt(membrane, cells))
      break;
    cut_mesh();
  }
  check_wall(adaptation.limited(parameters.mesh.largest_level()));
}

template <int dim>
bool InitialMembrane<dim>::refine_mesh(const std::vector<CellSample<dim>> &cells)
{
  gather_patches(); // make_level_set() has moved the membrane
  if (!adaptation.adapt(samples(), cells))
    return false;
  make_mesh(cells);
  return true;
}

template <int dim>
void InitialMembrane<dim>::make_level_set()
{
  checks.nothing_lost(lost_parts());
  checks.on_mesh(projection.get());
  checks.membrane(*distance, *projection);
  const CutGeometry<dim> &geometry = interface.geometry();
  const double area = geometry.enclosed_volume(), arclength = geometry.measure();
  // The cut cells have the membrane up to an error of interpolation, the expression has it exactly.
  interface.set_distance(*projection,
                         [&](const ClosestPoint<dim> &closest) {
                           return distance->offset(closest.point, closest.normal,
                                                   largest_offset * patches[closest.patch].size);
                         });
  interface.cut();
  checks.distance(area, geometry.enclosed_volume(), arclength, geometry.measure());
}

template <int dim>
void InitialMembrane<dim>::make_phases(SurfaceSolver<dim> &surface,
                                       const MembranePointValues *const curvature) const
{
  surface.initialise(interface, *concentration, *total_concentration, curvature);
}

template class InitialMembrane<2>;
template class InitialMembrane<3>;
} // namespace Gemmule
