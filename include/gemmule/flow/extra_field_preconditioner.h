// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/linear_system.h>

namespace Gemmule
{
/**
 * An approximate inverse of the Schur complement of an extra field: of its block of the flow's matrix, and of
 * what the flow answers to the field, D - E A^-1 E^T (doc/method-flow.md).
 */
class ExtraFieldPreconditioner
{
public:
  virtual ~ExtraFieldPreconditioner() = default;

  /** @param residual, solution the owned unknowns of the field, in their order. Collective. */
  virtual void apply(const double *residual, double *solution) const = 0;
};
} // namespace Gemmule
