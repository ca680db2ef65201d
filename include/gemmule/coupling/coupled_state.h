// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/coupling/history.h>
#include <gemmule/coupling/mesh_policy.h>
#include <gemmule/coupling/reference_measures.h>
#include <gemmule/mesh/mesh_cells.h>

namespace Gemmule
{
class ArrayExchange;

/**
 * Everything that CoupledSystem carries from one accepted step to the next: continuing from it gives what
 * the run would have given. Independent of the number of ranks and complete on each of them.
 *
 * A new member needs a line in exchange() (coupled_state.cc), which both saves and restores it, and in
 * CoupledSystem::state() and restore().
 */
template <int dim>
struct CoupledState
{
  AcceptedLevels<dim> levels;
  ReferenceMeasures reference;
  double grid_scale_rigidity = 0.;

  std::vector<MeshCell<dim>> mesh; ///< refinement has hysteresis, so that the membrane does not imply it
  MeshPolicyMemory<dim> mesh_policy;
  unsigned int lowered_levels = 0;           ///< by the limit on the number of cells
  std::vector<MeshCell<dim>> membrane_cells; ///< by which the mesh is divided among the ranks
  /** Of all cells: far from the membrane the level set stays from the last change of the mesh. */
  std::vector<LevelSetCell<dim>> level_set;
  bool level_set_is_set_everywhere = false;
};

/** Saves or restores all members. */
template <int dim>
void exchange(ArrayExchange &archive, CoupledState<dim> &state);
} // namespace Gemmule
