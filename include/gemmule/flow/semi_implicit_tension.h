// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/flow_term.h>

namespace Gemmule
{
/**
 * Damps the fast shape modes of the explicit coupling of membrane and flow: adds
 *
 *   (S dt / Ca) int_Gamma max(sigma, 0) P grad(w) n . P grad <v> n + E div_s w div_s <v>,
 *   w = <u> - u_old,  P = I - n n^T,
 *
 * to the flow problem: S dt times the linearised stiffness of the tension against normal displacements and of
 * the membrane against dilatation. u_old is the velocity of the same material points one step ago, so that
 * the term is O(dt^2) and the scheme stays second order. In the linear model (decay rate lambda, BDF2 with
 * extrapolated velocity) the coupling is stable for dt lambda < 4/3 with S = 0, < 6.7 with S = 0.3 and for
 * every step with S >= 0.4 (doc/method.md).
 */
template <int dim>
class SemiImplicitTension : public FlowTerm<dim>
{
public:
  using typename FlowTerm<dim>::Vector;
  using NodalVelocity = std::array<dealii::Tensor<1, dim>, TensorLagrange<dim, 3>::n>;

  struct Parameters
  {
    double coefficient;                       ///< S dt
    MembranePointValues tension;              ///< sigma
    MembranePointValues dilatational_modulus; ///< E = -d sigma / d log(length); empty: 0
    std::vector<NodalVelocity> old_velocity;  ///< u_old on the cut cells, Q3
  };

  SemiImplicitTension(Parameters parameters, const double capillary_number)
      : parameters(std::move(parameters)), capillary_number(capillary_number)
  {
  }

  void add_matrix(const FlowTermContext<dim> &context, Vector &right_side) const override;

  /** The part of u_old. */
  void add_right_side(const FlowTermContext<dim> &context, Vector &right_side) const override;

private:
  /** (S dt / Ca) times the weight of a quadrature point times max(sigma, 0), and times E. */
  std::pair<double, double> weights(const CutCell<dim> &cell, unsigned int k, unsigned int q) const;

  const Parameters parameters;
  const double capillary_number;
};
} // namespace Gemmule
