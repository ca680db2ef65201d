// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/geometry/membrane_motion.h>

#include <mpi.h>
#include <vector>

namespace Gemmule
{
/**
 * What the nodes of a cut cell of the membrane at level n+1 receive from that at level n along the
 * trajectories. Names as in MembraneFields: what ends in k_back is of level n+1-k.
 */
template <int dim>
struct TransportedFields
{
  using Scalar = typename MembraneFields<dim>::Scalar;
  using Vector = typename MembraneFields<dim>::Vector;

  Vector advecting_velocity{};   ///< u*, the velocity that moved the membrane
  Vector displacement{};         ///< x - X
  Vector velocity_1_back{};      ///< <u>^n(X)
  Scalar concentration_1_back{}; ///< f^n(X)
  Scalar concentration_2_back{}; ///< f^{n-1} at the same material point
  Scalar concentration_3_back{}; ///< f^{n-2} at the same material point
};

/** The fields of @p motion at the nodes of the given cut cells. */
template <int dim>
std::vector<TransportedFields<dim>> transport_fields(const MembraneMotion<dim> &motion,
                                                     const std::vector<CutCell<dim>> &cut_cells);

/** Nodal values on the given cut cells of a field of another membrane, extended constantly along its normals.
 */
template <int dim>
std::vector<typename MembraneFields<dim>::Scalar>
extend_along_normals(const MembraneProjection<dim> &membrane,
                     typename MembraneFields<dim>::Scalar MembraneFields<dim>::*field,
                     const std::vector<CutCell<dim>> &cut_cells);

/**
 * Collects the cut cells of all ranks with their fields, ordered by position so that the result does not
 * depend on the number of ranks. Collective.
 */
template <int dim>
std::vector<MembranePatch<dim>> gather_patches(const std::vector<CutCell<dim>> &cut_cells,
                                               const std::vector<MembraneFields<dim>> &fields,
                                               MPI_Comm communicator);

/** The same without fields. Collective. */
template <int dim>
std::vector<MembranePatch<dim>> gather_bare_patches(const CutGeometry<dim> &geometry, MPI_Comm communicator);

/** The quadrature points on the given cut cells, of a membrane without concentrations. */
template <int dim>
MembraneCloud<dim> bare_cloud(const CutGeometry<dim> &geometry);

/** Collects the points of all ranks, ordered by position. Collective. */
template <int dim>
MembraneCloud<dim> gather_cloud(const MembraneCloud<dim> &local, MPI_Comm communicator);
} // namespace Gemmule
