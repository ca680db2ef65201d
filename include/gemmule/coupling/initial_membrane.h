// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/coupling/initial_checks.h>
#include <gemmule/coupling/lost_parts.h>
#include <gemmule/geometry/interface.h>
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

  /**
   * All arguments are kept by reference.
   * @param triangulation whose cells have the level of the bulk
   * @throws ParameterError for expressions that cannot be parsed
   */
  InitialMembrane(const AllParameters &parameters, Triangulation &triangulation, Interface<dim> &interface,
                  MeshAdaptation<dim> &adaptation);

  /**
   * Looks for the membrane in the whole box, which is all that is asked of the sign of the level set away
   * from it; to be called first. Throws UserError when there is none, or the level set jumps from one sign to
   * the other or is not finite. Collective.
   */
  void find();

  /** Warnings about what find() may have missed. */
  const std::vector<std::string> &warnings() const { return search_warnings; }

  /**
   * Refines the mesh until it satisfies the criteria for the initial membrane and composition. The interface
   * is then cut by the distance from the membrane that was found. Throws UserError when there is no membrane
   * in the box, or it touches the wall, or a concentration is not finite or not positive on it.
   * @param cells of the flow on the present mesh, where the flow is known already. Collective.
   */
  void make_mesh(const std::vector<CellSample<dim>> &cells = {});

  /**
   * Asks the criteria once more, with the flow known.
   * @return whether the mesh has changed; the interface is that of make_mesh() then, and as it was otherwise.
   * Collective.
   */
  bool refine_mesh(const std::vector<CellSample<dim>> &cells);

  /** Makes the level set of make_mesh() the signed distance from the membrane. Collective. */
  void make_level_set();

  /** Initial concentrations on that membrane. @p curvature of it; nullptr without bending. Collective. */
  void make_phases(SurfaceSolver<dim> &surface, const MembranePointValues *curvature) const;

private:
  /** Refines towards the points that were found until their cells have the membrane's level. */
  void refine_towards_membrane();
  /** On a mesh that has changed: level set, cut cells and patches of the distance from what was found. */
  void cut_mesh();
  /** Patches of the interface as it is now. */
  void gather_patches();
  /** Where the membrane of the patches is, curvature and composition there. */
  std::vector<MembraneSample<dim>> samples() const;
  /** Of the patches. */
  std::vector<LostPart<dim>> lost_parts() const;
  /**
   * Refines the cells of parts that are too small for them, as far as the finest level allows.
   * @return whether the mesh has changed. Collective.
   */
  bool refine_lost_parts();
  void check_sign() const;
  /** On the final mesh: the criteria refine towards a wall that is near. */
  void check_wall(unsigned int finest_level) const;
  void check_expressions(const std::vector<MembraneSample<dim>> &membrane) const;

  const AllParameters &parameters;
  const MPI_Comm communicator;
  Triangulation &triangulation;
  Interface<dim> &interface;
  MeshAdaptation<dim> &adaptation;
  const InitialChecks<dim> checks;
  std::unique_ptr<dealii::Function<dim>> shape, concentration, total_concentration, prescribed_tension;
  std::vector<MembraneRoot<dim>> roots; ///< one in each cell of the membrane's level, or finer ones
  std::unique_ptr<ZeroSetDistance<dim>> distance;
  std::vector<std::string> search_warnings;

  std::vector<MembranePatch<dim>> patches;             ///< of the interface, complete on every rank
  std::unique_ptr<MembraneProjection<dim>> projection; ///< onto them; nullptr where there is no membrane
};
} // namespace Gemmule
