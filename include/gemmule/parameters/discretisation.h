// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace dealii
{
class ParameterHandler;
}

namespace Gemmule::Parameters
{
/** How the linear equations of the flow are solved. */
enum class FlowSolver
{
  automatic, ///< whatever is faster (doc/performance.md)
  direct,
  iterative
};

/** Section "Flow discretisation": penalties of the unfitted Stokes method, and the solution of its equations
 * (doc/method-flow.md). */
struct Flow
{
  /** gamma of (gamma eta_Gamma / h) [u].[v]. */
  double nitsche_penalty = 40.;
  /** g_1 of g_1 h [d_n u].[d_n v]. */
  double velocity_gradient_ghost_penalty = 0.01;
  /** g_2 of g_2 h^3 [d_nn u].[d_nn v]. */
  double velocity_curvature_ghost_penalty = 0.001;
  /** g_p of (g_p / eta) h^3 [d_n p][d_n q]. */
  double pressure_ghost_penalty = 0.01;
  FlowSolver solver = FlowSolver::automatic;
  /** Of the iterative solver: Euclidean norm of the residual by that of the right side. */
  double solver_tolerance = 1e-8;
  unsigned int largest_number_of_iterations = 300;

  void add_parameters(dealii::ParameterHandler &prm);
  void check() const;
};

/** Section "Surface discretisation": trace finite elements and the Cahn-Hilliard solve
 * (doc/method-surface.md). */
struct Surface
{
  /** rho of (rho / h) (n.grad f)(n.grad v) on the active mesh. */
  double normal_stabilisation = 1.;
  /** Newton stops when the residual has fallen by this factor. */
  double newton_tolerance = 1e-10;
  unsigned int newton_maximum_iterations = 20;

  void add_parameters(dealii::ParameterHandler &prm);
  void check() const;
};
} // namespace Gemmule::Parameters
