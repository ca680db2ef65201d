// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/stokes_solver.h>
#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/geometry/membrane_motion.h>
#include <gemmule/mesh/mesh_adaptation.h>
#include <gemmule/parameters/domain.h>
#include <gemmule/parameters/membrane.h>
#include <gemmule/parameters/mesh.h>

#include <deal.II/base/timer.h>
#include <deal.II/distributed/tria.h>

#include <vector>

namespace Gemmule
{
/**
 * What MeshPolicy carries from one step to the next; with the cells of the mesh all that there is to save. A
 * new member needs a line in exchange() (coupled_state.cc).
 */
template <int dim>
struct MeshPolicyMemory
{
  unsigned int steps_since_remeshing = 0;    ///< tries
  unsigned int n_steps_on_mesh = 0;          ///< accepted ones since the last change of the mesh
  std::vector<CellSample<dim>> flow_samples; ///< error of the current flow; empty if no criterion needs it
};

/** Decides when the mesh is adapted in the course of a run, and for what: present and next place of the
 * membrane, and the error of the flow. */
template <int dim>
class MeshPolicy
{
public:
  using Triangulation = dealii::parallel::distributed::Triangulation<dim>;

  /** @p triangulation, @p mesh, @p domain and @p timer are kept by reference. */
  MeshPolicy(Triangulation &triangulation, const Parameters::Mesh &mesh, const Parameters::Domain &domain,
             const Parameters::Membrane &membrane, dealii::TimerOutput &timer);

  /**
   * Adapts the mesh to the membrane before and after @p motion, if one of both has too coarse cells around it
   * or "Remeshing interval" tries have gone by.
   * @return whether the mesh has changed. Collective.
   */
  bool adapt(const MembraneMotion<dim> &motion);

  /** A step has been accepted. */
  void accept() { ++memory.n_steps_on_mesh; }

  /** The levels that were computed so far are of no account any more. */
  void begin_anew() { memory.n_steps_on_mesh = 0; }

  /** Samples the error of the last flow for the criteria that need it. Collective. */
  void sample_flow(const StokesSolver<dim> &flow);
  /** Of all ranks; empty if no criterion needs them. */
  const std::vector<CellSample<dim>> &flow_samples() const { return memory.flow_samples; }

  /** @throws StepBreakdown if some cut cell is coarser than "Membrane level". Collective. */
  void check_refined(const CutGeometry<dim> &geometry) const;

  /** Edge of the cells of "Membrane level" (length), as far as the limit on their number leaves it. */
  double membrane_cell_size() const;

  /** Has the mesh changed within the time levels that the estimated errors of a step look at? */
  bool mesh_is_new() const { return memory.n_steps_on_mesh < 3; }
  /** How often the mesh has changed in adapt(). */
  unsigned int mesh_changes() const { return n_mesh_changes; }
  /** Levels that the limit on the number of cells has taken away. */
  unsigned int lowered_levels() const { return mesh_adaptation.lowered_levels(); }

  MeshAdaptation<dim> &adaptation() { return mesh_adaptation; }
  const MeshAdaptation<dim> &adaptation() const { return mesh_adaptation; }

  const MeshPolicyMemory<dim> &get_memory() const { return memory; }
  void restore(const MeshPolicyMemory<dim> &earlier, unsigned int lowered_levels);

private:
  /** Samples of the membrane at its present and at its next position. */
  std::vector<MembraneSample<dim>> samples(const MembraneMotion<dim> &motion) const;

  Triangulation &triangulation;
  const Parameters::Mesh &parameters;
  const Parameters::Domain &domain;
  const bool has_phases;
  dealii::TimerOutput &timer;
  MeshAdaptation<dim> mesh_adaptation;
  MeshPolicyMemory<dim> memory;
  unsigned int n_mesh_changes = 0;
};
} // namespace Gemmule
