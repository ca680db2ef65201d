// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/stokes_solver.h>
#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/surface/surface_solver.h>

#include <mpi.h>

namespace Gemmule
{
/** Estimated local errors of a step. */
struct StepErrors
{
  double shape = 0.;       ///< of the membrane's position (length)
  double composition = 0.; ///< of f (dimensionless)
};

/** The step in work and the two before it, newest first (dimensionless time); zero where there is none. */
struct StepSizes
{
  double current = 0.;
  double previous = 0.;
  double preceding = 0.;
};

/**
 * f at the new time, extrapolated along the trajectories: quadratically as soon as there are three old
 * levels, before that with what there is. First guess of Newton's method, and predictor of the error
 * estimate.
 */
template <int dim>
CutCellScalar<dim> predict_concentration(const std::vector<TransportedFields<dim>> &transported,
                                         const StepSizes &steps);

/**
 * Largest estimates over the membrane. Position: BDF2 with the velocity that came out instead of the
 * extrapolated one differs by dt/a0 (u - u*), which is the leading part of the local error. Concentration:
 * Milne's device on the quadratic predictor and BDF2, whose local errors are
 * dt (dt + dt1)(dt + dt1 + dt2)/6 and dt^2 (dt + dt1)^2 / (6 (2 dt + dt1)) times f''' (zero before there are
 * three old levels).
 *
 * Throws SimulationError when velocity or concentration are not finite. Collective.
 *
 * @param surface nullptr with a prescribed tension
 */
template <int dim>
StepErrors estimate_step_errors(const CutGeometry<dim> &geometry, const StokesSolver<dim> &flow,
                                const SurfaceSolver<dim> *surface,
                                const std::vector<TransportedFields<dim>> &transported,
                                const CutCellScalar<dim> &predicted_concentration, const StepSizes &steps,
                                MPI_Comm communicator);
} // namespace Gemmule
