// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/coupling/lost_parts.h>
#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/mesh/mesh_adaptation.h>
#include <gemmule/parameters/all_parameters.h>
#include <gemmule/surface/surface_solver.h>

#include <deal.II/base/function.h>
#include <deal.II/distributed/tria.h>

#include <memory>

namespace Gemmule
{
/**
 * The membrane that the parameters describe by expressions: resolves it by the mesh, makes the level set its
 * signed distance and checks what can only be checked on the membrane itself.
 */
template <int dim>
class InitialMembrane
{
public:
  using Triangulation = dealii::parallel::distributed::Triangulation<dim>;

  /** @throws ParameterError for expressions that cannot be parsed */
  InitialMembrane(const AllParameters &parameters, MPI_Comm communicator);

  /**
   * Looks for the membrane in the whole box, which is all that is asked of the sign of the level set away
   * from it; to be called first. Throws UserError when there is none, or the level set jumps from one sign to
   * the other or is not finite.
   * @param triangulation whose cells have the level of the bulk. Collective.
   */
  void find(const Triangulation &triangulation);

  /** Warnings about what find() may have missed. */
  const std::vector<std::string> &warnings() const { return search_warnings; }

  /**
   * Refines the mesh until it satisfies the criteria for the initial membrane and composition.
   * Throws UserError when there is no membrane in the box, or it touches the wall, or a concentration is not
   * finite or not positive on it.
   * @param cells of the flow on the present mesh, where the flow is known already. Collective.
   */
  void make_mesh(Triangulation &triangulation, LevelSet<dim> &level_set, CutGeometry<dim> &geometry,
                 MeshAdaptation<dim> &adaptation, const std::vector<CellSample<dim>> &cells = {}) const;

  /**
   * Asks the criteria once more, with the flow known. @p origin of the box.
   * @return whether the mesh has changed; level set and geometry are those of make_mesh() then, and as they
   * were otherwise. Collective.
   */
  bool refine_mesh(const dealii::Point<dim> &origin, Triangulation &triangulation, LevelSet<dim> &level_set,
                   CutGeometry<dim> &geometry, MeshAdaptation<dim> &adaptation,
                   const std::vector<CellSample<dim>> &cells) const;

  /** Level set := signed distance of the membrane, and its geometry, on a mesh that is final. Collective. */
  void make_level_set(const dealii::Point<dim> &origin, LevelSet<dim> &level_set,
                      CutGeometry<dim> &geometry) const;

  /** Initial concentrations on that membrane. @p curvature of it; nullptr without bending. Collective. */
  void make_phases(const LevelSet<dim> &level_set, const CutGeometry<dim> &geometry,
                   SurfaceSolver<dim> &surface, const MembranePointValues *curvature) const;

private:
  /** Where the membrane is, curvature and composition there. */
  std::vector<MembraneSample<dim>> samples(const dealii::Point<dim> &origin,
                                           const CutGeometry<dim> &geometry) const;
  /** Refines towards the points that were found until their cells have the membrane's level. */
  void refine_towards_membrane(Triangulation &triangulation) const;
  /** Level set and cut cells of the distance from the membrane that was found. */
  void cut_mesh(LevelSet<dim> &level_set, CutGeometry<dim> &geometry) const;
  /**
   * Refines the cells of parts that are too small for them, as far as the finest level allows.
   * @return whether the mesh has changed. Collective.
   */
  bool refine_lost_parts(Triangulation &triangulation, const LevelSet<dim> &level_set,
                         const CutGeometry<dim> &geometry) const;
  void check_sign(const Triangulation &triangulation, const CutGeometry<dim> &geometry) const;
  /** On the final mesh: the criteria refine towards a wall that is near. */
  void check_wall(const Triangulation &triangulation, const CutGeometry<dim> &geometry,
                  unsigned int finest_level) const;
  void check_expressions(const std::vector<MembraneSample<dim>> &membrane) const;

  const AllParameters parameters;
  const MPI_Comm communicator;
  std::unique_ptr<dealii::Function<dim>> shape, concentration, total_concentration, prescribed_tension;
  std::vector<MembraneRoot<dim>> roots; ///< one in each cell of the membrane's level, or finer ones
  std::unique_ptr<ZeroSetDistance<dim>> distance;
  std::vector<std::string> search_warnings;
};
} // namespace Gemmule
