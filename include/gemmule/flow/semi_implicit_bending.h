// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/semi_implicit_tension.h>
#include <gemmule/surface/trace_space.h>

namespace Gemmule
{
/**
 * Damps the fast shape modes of the explicit coupling of bending and flow: adds to the flow problem
 *
 *   (S dt k / Ca) int grad_s z . (grad_s <v>)^T n,     int z y + h int_active (n.grad z)(n.grad y)
 *                                                      = int grad_s y . (grad_s w)^T n   for all y,
 *
 * w = <u> - u_old as in SemiImplicitTension: S dt times the linearised bending stiffness, since z is the rate
 * of change of the curvature in the same trace space in which the bending force has it. With the largest
 * rigidity k the damping is as strong as needed everywhere. z enters the flow system as an additional
 * unknown on the cut cells, scaled with sqrt(S dt k / Ca), which keeps the matrix symmetric.
 *
 * The part of u_old is filtered by 2F - F^2, F = (1 - h^2 Laplace_s)^{-1}: waves of many cells keep their
 * past up to (h k)^4, those of a cell, which are mostly errors of the transfer between two mesh positions,
 * lose it. A time step is then not limited by h^3 (doc/method.md).
 */
template <int dim>
struct SemiImplicitBending
{
  using NodalVelocity = typename SemiImplicitTension<dim>::NodalVelocity;

  double coefficient = 0.;                                  ///< S dt k
  const TraceSpace<dim> *space = nullptr;                   ///< its active mesh: the cut cells
  const std::vector<NodalVelocity> *old_velocity = nullptr; ///< u_old on the cut cells, Q3

  /** Additional unknowns, on all ranks. */
  unsigned int n_unknowns() const { return space->n_unknowns(); }

  /**
   * Adds one element per cut cell, with the unknowns of its flow followed by those of z, to a system to which
   * the elements of the flow have been added. @p first_unknown: number of flow unknowns.
   */
  void add_elements(unsigned int first_unknown, const std::vector<StokesCellElement> &cut_cell_elements,
                    ElementSystem &system);

  /** Adds the matrices of these elements, and what they do to boundary values to @p rhs. */
  void add_matrix(const CutGeometry<dim> &geometry, const MembraneForce<dim> &force, double capillary_number,
                  const FluidPair &fluids, ElementSystem &system, std::vector<double> &rhs) const;

  /** Adds this rank's part of the right side, that of u_old. */
  void add_rhs(const CutGeometry<dim> &geometry, double capillary_number, const ElementSystem &system,
               std::vector<double> &rhs) const;

private:
  std::vector<unsigned int> elements; ///< by cut cell
};
} // namespace Gemmule
