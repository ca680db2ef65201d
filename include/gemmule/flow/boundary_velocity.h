// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/stokes_layout.h>

#include <deal.II/base/function.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/affine_constraints.h>

#include <vector>

namespace Gemmule
{
/**
 * Dirichlet data u_infinity on the boundary of the box as constraints of the outside velocity
 * (doc/method-flow.md).
 *
 * The nodal interpolant of a solenoidal field has a small net flux through the boundary, for which the
 * discrete incompressible problem has no solution. It is removed by a multiple of the outer normal.
 */
template <int dim>
class BoundaryVelocity
{
public:
  /**
   * Finds the velocity dofs on the boundary and the weights of their flux. Collective.
   * @param hanging_nodes constraints of the hanging nodes, closed
   */
  void reinit(const dealii::DoFHandler<dim> &dof_handler,
              const dealii::AffineConstraints<double> &hanging_nodes);

  /**
   * Adds the lines u = u_infinity to @p constraints, which hold the hanging nodes and are not closed yet.
   * @param velocity dim components, its time set by the caller
   * Collective.
   * @throws ParameterError on all ranks if u_infinity is not finite on the walls at its time, or if its flux
   * is too large to be an error of interpolation
   */
  void constrain(const dealii::Function<dim> &velocity, dealii::AffineConstraints<double> &constraints);

  /** Net flux of the interpolated data that the last call of constrain() removed. */
  double removed_flux() const { return flux; }

private:
  struct BoundaryDof
  {
    dealii::types::global_dof_index dof;
    unsigned int component;
    dealii::Point<dim> point;
    double flux_weight; ///< integral of (shape function) . (outer normal) over the boundary
    bool owned;
  };
  std::vector<BoundaryDof> boundary_dofs;
  MPI_Comm communicator = MPI_COMM_SELF;
  double boundary_measure = 0.; ///< sum of |flux_weight|
  double flux = 0.;
};
} // namespace Gemmule
