// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/linear_system.h>
#include <gemmule/surface/total_concentration.h>

namespace Gemmule
{
/**
 * Transport of the total concentration by the conservative Eulerian scheme (doc/method-surface.md):
 *
 *   (1/dt)(a0 int_n fbar v + a1 int_{n-1} fbar v + a2 int_{n-2} fbar v) - int_n fbar u.grad v
 *     + D int_n grad_s fbar.grad_s v + (rho/h) int_active (n.grad fbar)(n.grad v) = 0
 *
 * with sums over the stored clouds for the earlier membranes. With v = 1 all terms but the first three
 * vanish: the mass is exact to round-off on any sequence of meshes.
 */
template <int dim>
class ConservativeTransport : public TotalConcentration<dim>
{
public:
  /** @param diffusion D, dimensionless @param stabilisation rho */
  ConservativeTransport(double diffusion, double stabilisation, MPI_Comm communicator);

  TraceField<dim> advance(const TraceSpace<dim> &space, const SurfaceStep<dim> &step) override;

private:
  double diffusion, stabilisation;
  LinearSystem system;
};
} // namespace Gemmule
