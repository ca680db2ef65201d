// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/coupling/membrane_flow.h>
#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_snapshot.h>
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/surface/surface_solver.h>

#include <vector>

namespace Gemmule
{
/** Membrane, phases and flow of one time level as the mesh has them. Refers to what others own. */
template <int dim>
struct LevelOnMesh
{
  const Interface<dim> &interface;
  const MembraneFlow<dim> &flow;
  const SurfaceSolver<dim> *surface; ///< nullptr with a prescribed tension
};

/** What a membrane without a past carries along: the velocity that it has. */
template <int dim>
std::vector<TransportedFields<dim>> fields_without_past(const StokesSolver<dim> &flow);

/**
 * The level at @p time, independent of the mesh and complete on every rank.
 * @param origin lower corner of the box
 * @param transported from the level before. Collective.
 */
template <int dim>
MembraneSnapshot<dim> take_snapshot(double time, const dealii::Point<dim> &origin,
                                    const LevelOnMesh<dim> &level,
                                    const std::vector<TransportedFields<dim>> &transported);
} // namespace Gemmule
