// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/stokes_solver.h>
#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/geometry/membrane_transport.h>
#include <gemmule/surface/surface_solver.h>
#include <gemmule/time/time_step.h>

#include <mpi.h>

namespace Gemmule
{
/** Estimated local errors of a step. */
struct StepErrors
{
  double shape = 0.;       ///< of the membrane's position (length)
  double composition = 0.; ///< of f (dimensionless)
};

/**
 * f at level n+1, extrapolated along the trajectories (TimeStep::extrapolation). First guess of Newton's
 * method, and predictor of the error estimate.
 */
template <int dim>
CutCellScalar<dim> predict_concentration(const std::vector<TransportedFields<dim>> &transported,
                                         const TimeStep &step);

/**
 * Largest estimates over the membrane. Position: BDF2 with the velocity that came out instead of the
 * extrapolated one differs by dt/a0 (u - u*), which is the leading part of the local error. Concentration:
 * Milne's device on the quadratic predictor and BDF2 (TimeStep::milne_factor; zero before there are three old
 * levels).
 *
 * Throws SimulationError when velocity or concentration are not finite. Collective.
 *
 * @param surface nullptr with a prescribed tension
 */
template <int dim>
StepErrors estimate_step_errors(const CutGeometry<dim> &geometry, const StokesSolver<dim> &flow,
                                const SurfaceSolver<dim> *surface,
                                const std::vector<TransportedFields<dim>> &transported,
                                const CutCellScalar<dim> &predicted_concentration, const TimeStep &step,
                                MPI_Comm communicator);
} // namespace Gemmule
