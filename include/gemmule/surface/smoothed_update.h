// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/linear_system.h>
#include <gemmule/surface/total_concentration.h>

namespace Gemmule
{
/**
 * Update smoothing (doc/model.md, "The total concentration"): the rate of change r at a fixed point
 * of the normally extended total concentration is low-pass filtered, r = (I + delta Laplace_s^2)^{-1} (-S),
 * with S = u.grad_s fbar + fbar div_s u taken of the predicted fbar. As a mixed problem of second order on
 * the membrane at t_n,
 *
 *   m(r, v) + delta a(z, v) = (-S, v),   m(z, y) - a(r, y) = 0,
 *   m(r, v) = (r, v) + rho h s(r, v),    a(r, v) = (grad_s r, grad_s v) + (rho/h) s(r, v),
 *
 * s(a, b) = int_active (n.grad a)(n.grad b), followed by a0 fbar + a1 fbar_{n-1} + a2 fbar_{n-2} = dt r with
 * the earlier fields extended to the membrane at t_n. With the matrices M and A of the two forms the discrete
 * filter is (M + delta A M^{-1} A)^{-1}: a contraction for every delta, and one that leaves the mean of -S as
 * it is. The step is not conservative by itself; a constant is added to fbar in the end that makes the mass
 * that of the cloud at t_{n-1}.
 */
template <int dim>
class SmoothedUpdate : public TotalConcentration<dim>
{
public:
  /** @param smoothing delta, dimensionless @param stabilisation rho */
  SmoothedUpdate(double smoothing, double stabilisation, MPI_Comm communicator);

  /** Throws SimulationError where the total concentration has reached zero: the model ends there. */
  TraceField<dim> advance(const TraceSpace<dim> &space, const SurfaceStep<dim> &step) override;
  double last_shift() const override { return shift; }
  bool needs_extended_fields() const override { return true; }

  /** r for given S, one number per quadrature point of each locally owned cut cell. Collective. */
  TraceField<dim> smoothed_rate(const TraceSpace<dim> &space, const std::vector<std::vector<double>> &source);

private:
  std::vector<std::vector<double>> source(const TraceSpace<dim> &space, const SurfaceStep<dim> &step) const;
  TraceField<dim> integrate(const TraceSpace<dim> &space, const SurfaceStep<dim> &step,
                            const TraceField<dim> &rate) const;
  void restore_mass(const TraceSpace<dim> &space, const MembraneCloud<dim> &previous, TraceField<dim> &field);

  double smoothing, stabilisation;
  LinearSystem system;
  double shift = 0.;
};
} // namespace Gemmule
