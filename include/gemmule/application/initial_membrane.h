#pragma once

#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/geometry/level_set.h>
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
  /** Refines towards sign changes of the expression until they have the membrane's level. */
  void find(Triangulation &triangulation) const;
  void check_sign(const Triangulation &triangulation, const CutGeometry<dim> &geometry) const;
  /** On the final mesh: the criteria refine towards a wall that is near. */
  void check_wall(const Triangulation &triangulation, const CutGeometry<dim> &geometry,
                  unsigned int finest_level) const;
  void check_expressions(const std::vector<MembraneSample<dim>> &membrane) const;

  const AllParameters parameters;
  const MPI_Comm communicator;
  std::unique_ptr<dealii::Function<dim>> shape, concentration, total_concentration, prescribed_tension;
};
} // namespace Gemmule
