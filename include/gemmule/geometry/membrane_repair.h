// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_projection.h>

#include <mpi.h>
#include <vector>

namespace Gemmule
{
/**
 * Edge length h of the largest cell in which the mesh does not resolve the membrane; 0 if there is none. That
 * is where h |curvature| exceeds @p largest_curvature, or two sheets that face in opposite directions lie in
 * one cell.
 */
template <int dim>
double largest_unresolved_cell(const MembraneProjection<dim> &membrane, double largest_curvature);

/**
 * Removes what is thinner than twice @p radius from the shape, by a morphological closing followed by an
 * opening of the inside with balls of this radius: films of outer fluid between two sheets are bridged,
 * threads of inner fluid are cut, folds and spikes are rounded. Where the radius of curvature exceeds
 * @p radius the membrane stays, up to the error of making distances, O(h^4) each time. The topology changes
 * where that removes the last connection. The enclosed area is not kept.
 *
 * @param membrane of which patches, narrow band and points are taken
 * @param interface becomes the new membrane, its level set a signed distance, and cut
 * @return arclength (area in 3D) of the membrane before
 * @throws SimulationError if nothing is left. Collective.
 */
template <int dim>
double remove_small_features(const MembraneSnapshot<dim> &membrane, double radius, Interface<dim> &interface,
                             MPI_Comm communicator);

/**
 * Points of either membrane that are farther from the other one than a twentieth of the old membrane's
 * largest cell: what a repair has moved, removed or made.
 *
 * @param geometry cut mesh of the repaired membrane. Collective.
 */
template <int dim>
std::vector<dealii::Point<dim>> find_repaired_points(const MembraneProjection<dim> &old_membrane,
                                                     const CutGeometry<dim> &geometry,
                                                     const dealii::Point<dim> &origin, MPI_Comm communicator);

/**
 * Carries concentrations over to a repaired membrane. They are those at the closest points of the old one,
 * times 1 + a psi(x), with a such that the mass is that of the old membrane. psi = exp(-(d/R)^2), with d the
 * distance to the repaired points and R eight cells, so that what two membranes had where they have
 * merged goes to the neighbourhood; if that would ask for |a| > 1/4, psi = 1.
 */
template <int dim>
class RepairedConcentration : public dealii::Function<dim>
{
public:
  using Field = typename MembraneFields<dim>::Scalar MembraneFields<dim>::*;

  /**
   * @param old_membrane must outlive the object
   * @param mass of the old membrane
   * @param geometry cut mesh of the repaired membrane
   * @param repaired_points of find_repaired_points(); must outlive the object. Collective.
   */
  RepairedConcentration(const MembraneProjection<dim> &old_membrane, Field field, double mass,
                        const CutGeometry<dim> &geometry,
                        const std::vector<dealii::Point<dim>> &repaired_points, MPI_Comm communicator);

  double value(const dealii::Point<dim> &x, unsigned int component = 0) const override;

private:
  double carried(const dealii::Point<dim> &x) const;
  double weight(const dealii::Point<dim> &x) const;

  const MembraneProjection<dim> &old_membrane;
  const Field field;
  const double neighborhood; ///< R
  const std::vector<dealii::Point<dim>> &repaired_points;
  bool is_local = true;
  double factor = 0.; ///< a
};
} // namespace Gemmule
