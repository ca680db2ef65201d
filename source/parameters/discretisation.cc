// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/discretisation.h>
#include <gemmule/parameters/section.h>

#include <deal.II/base/parameter_handler.h>

namespace Gemmule::Parameters
{
void Flow::add_parameters(dealii::ParameterHandler &prm)
{
  Section section(prm, {"Flow discretisation"});
  section.add("Nitsche penalty", nitsche_penalty,
              "gamma in (gamma eta/h) [u].[v] on the membrane, which makes the velocity continuous "
              "(dimensionless). Source: Hansbo, Larson, Zahedi (2014).",
              Range::positive());
  section.add(
      "Velocity gradient ghost penalty", velocity_gradient_ghost_penalty,
      "g_1 in g_1 h [d_n u].[d_n v] on the faces of cut cells, which keeps the conditioning independent of "
      "how the membrane cuts the cells (dimensionless). Source: Hansbo, Larson, Zahedi (2014).",
      Range::positive());
  section.add(
      "Velocity second derivative ghost penalty", velocity_curvature_ghost_penalty,
      "g_2 in g_2 h^3 [d_nn u].[d_nn v] on the faces of cut cells (dimensionless). Both velocity terms are "
      "needed with quadratic velocities.",
      Range::positive());
  section.add(
      "Pressure gradient ghost penalty", pressure_ghost_penalty,
      "g_p in (g_p/eta) h^3 [d_n p][d_n q] on the faces of cut cells (dimensionless). Source: Hansbo, "
      "Larson, Zahedi (2014).",
      Range::positive());
  section.add(
      "Solver", solver,
      "How the equations of the flow are solved. 'direct': factorisation by MUMPS. 'iterative': FGMRES "
      "with multigrid, which needs much less memory and time in 3D. 'automatic': whichever is faster.",
      {{"automatic", FlowSolver::automatic},
       {"direct", FlowSolver::direct},
       {"iterative", FlowSolver::iterative}});
  section.add("Solver tolerance", solver_tolerance,
              "The iterative solver stops when the residual has fallen to this part of the right side "
              "(dimensionless). The tension that pressure balances is most of the right side, so that the "
              "velocity needs small values: 1e-6 leaves errors of 1e-4 and more in it.",
              Range{0., 1e-2, true});
  section.add("Largest number of solver iterations", largest_number_of_iterations,
              "Where the iterative solver needs more iterations, the flow is solved directly if the memory "
              "allows it; otherwise the step is repeated with a smaller step size.",
              Range::between(1, 10000));
}

void Flow::check() const
{
  Flow copy(*this);
  dealii::ParameterHandler prm;
  copy.add_parameters(prm);
}

void Surface::add_parameters(dealii::ParameterHandler &prm)
{
  Section section(prm, {"Surface discretisation"});
  section.add(
      "Normal stabilisation", normal_stabilisation,
      "rho in (rho/h) (n.grad f)(n.grad v) on the band of cells around the membrane, which extends the "
      "surface fields along the normals (dimensionless). Source: Lehrenfeld, Olshanskii, Xu (2018).",
      Range::positive());
  section.add(
      "Newton tolerance", newton_tolerance,
      "Newton's method for the phases stops when linearising the chemical potential's local part anew "
      "changes it by less than this part of its largest value (dimensionless).",
      Range{0., 0.1, true});
  section.add("Largest number of Newton iterations", newton_maximum_iterations,
              "A time step that needs more iterations is repeated with a smaller step.",
              Range::between(1, 1000));
}

void Surface::check() const
{
  Surface copy(*this);
  dealii::ParameterHandler prm;
  copy.add_parameters(prm);
}
} // namespace Gemmule::Parameters
