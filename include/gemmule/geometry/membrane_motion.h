// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/geometry/membrane_projection.h>
#include <gemmule/time/time_step.h>

#include <vector>

namespace Gemmule
{
/**
 * Motion of the membrane over one time step along the trajectories of its points, BDF2 with extrapolated
 * velocity and variable step (dimensionless time):
 *
 *   (a0 X^{n+1} + a1 X^n + a2 X^{n-1}) / dt = u* = e1 <u>^n(X^n) + e2 <u>^{n-1}(X^{n-1})
 *
 * with the coefficients of BdfCoefficients, explicit Euler in the first step. X^{n-1} and <u>^{n-1}(X^{n-1})
 * are fields of the membrane at level n, extended constantly along normals. Stable for decay rates up to 4 /
 * (3 dt), where Adams-Bashforth 2 ends at 1 / dt.
 */
template <int dim>
class MembraneMotion
{
public:
  /** @param projection onto the membrane at level n; must outlive the object */
  MembraneMotion(const MembraneProjection<dim> &projection, const TimeStep &step);

  /** Where a point came from, and what moved it. */
  struct Trajectory
  {
    ClosestPoint<dim> departure_point;   ///< closest point on the old membrane of the old position
    dealii::Tensor<1, dim> displacement; ///< new minus old position
    dealii::Tensor<1, dim> velocity;     ///< u*
  };

  /**
   * Old position X with X + d(X) = x, d the displacement of the closest membrane point (fixed point; the
   * contraction rate is dt |grad_s u|). The new level set at x is the signed distance of the old position,
   * trajectory.departure_point.distance.
   */
  Trajectory trace_back(const dealii::Point<dim> &x) const;

  /** Displacement of a point of the old membrane. */
  dealii::Tensor<1, dim> displacement(const ClosestPoint<dim> &p) const;

  /**
   * Adds to u* the velocity due to a uniform tension (field tension_velocity) such that the moved membrane
   * has the length (area in 3D) @p measure, once a shift along its normal has made its volume @p volume: what
   * the extrapolation of the velocity lacks to keep the arclength. Newton's method on integrals over @p
   * cloud, the quadrature points of the old membrane. Does nothing where a tension hardly changes the length
   * (circle).
   * @return the added tension
   */
  double fit_measure(const MembraneCloud<dim> &cloud, double measure, double volume);

  const MembraneProjection<dim> &old_membrane() const { return projection; }

private:
  const MembraneProjection<dim> &projection;
  const double dt;
  const BdfCoefficients bdf;
  double added_tension = 0.;
};
} // namespace Gemmule
