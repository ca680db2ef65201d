// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/extra_field_preconditioner.h>
#include <gemmule/surface/trace_space.h>

namespace Gemmule
{
/**
 * The Schur complement of the field of SemiImplicitBending. A wave of wave number k of that field drives a
 * flow that bends the membrane by c k^3 / (2 (eta_1 + eta_2)) of it, c = S dt k_b / Ca: between the mass
 * matrix M of the field, for long waves, and c k^3 with the shortest wave that a cell of size h has. Hence
 *
 *   -(M + a K M^-1 K),  a = 3 c h / (pi (eta_1 + eta_2)),
 *
 * with K the stiffness matrix of the membrane, both with the stabilisation along normals. The system of the
 * field and of y = sqrt(a) M^-1 K z is factorised.
 */
template <int dim>
class BendingSchurComplement : public ExtraFieldPreconditioner
{
public:
  /** @param space of the field, prepared @param response 3 c / (pi (eta_1 + eta_2)). Collective. */
  BendingSchurComplement(const TraceSpace<dim> &space, double response);

  void apply(const double *residual, double *solution) const override;

private:
  mutable LinearSystem system;           // solve() leaves it as it is
  dealii::types::global_dof_index first; ///< of the owned unknowns of the field in the system
  unsigned int n_owned;
};
} // namespace Gemmule
