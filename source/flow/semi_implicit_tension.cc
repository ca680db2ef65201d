// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/semi_implicit_tension.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

template <int dim>
std::pair<double, double> SemiImplicitTension<dim>::weights(const CutCell<dim> &cell, const unsigned int k,
                                                            const unsigned int q) const
{
  const double weight = parameters.coefficient / capillary_number * cell.surface_weights[q];
  return {weight * std::max(parameters.tension[k][q], 0.),
          parameters.dilatational_modulus.empty() ? 0. : weight * parameters.dilatational_modulus[k][q]};
}

template <int dim>
void SemiImplicitTension<dim>::add_matrix(const FlowTermContext<dim> &context, Vector &right_side) const
{
  const auto &interface_velocity = context.interface_velocity;
  const auto &cells = interface_velocity.geometry().cut_cells();
  constexpr unsigned int n_nodes = InterfaceVelocity<dim>::n_nodes;
  for (unsigned int k = 0; k < cells.size(); ++k)
  {
    // [i][j][c][d]: int sigma n_c n_d grad_s phi_i . grad_s phi_j + E (grad_s phi_i)_c (grad_s phi_j)_d
    typename InterfaceVelocity<dim>::NodalMatrix stiffness{};
    for (unsigned int q = 0; q < cells[k].surface_weights.size(); ++q)
    {
      const auto [weight, dilatational_weight] = weights(cells[k], k, q);
      const Tensor<2, dim> nn = outer_product(cells[k].normals[q], cells[k].normals[q]);
      const auto &gradients = interface_velocity.tangential_gradient(k, q);
      for (unsigned int i = 0; i < n_nodes; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          stiffness[i][j] += (weight * (gradients[i] * gradients[j])) * nn +
                             dilatational_weight * outer_product(gradients[i], gradients[j]);
    }
    for (unsigned int i = 0; i < n_nodes; ++i)
      for (unsigned int j = i + 1; j < n_nodes; ++j)
        stiffness[i][j] = transpose(stiffness[j][i]);
    interface_velocity.add_matrix(k, stiffness, context.system, right_side);
  }
}

template <int dim>
void SemiImplicitTension<dim>::add_right_side(const FlowTermContext<dim> &context, Vector &right_side) const
{
  const auto &interface_velocity = context.interface_velocity;
  const auto &cells = interface_velocity.geometry().cut_cells();
  typename TensorLagrange<dim, 3>::Values values;
  typename TensorLagrange<dim, 3>::Gradients gradients;
  for (unsigned int k = 0; k < cells.size(); ++k)
  {
    typename InterfaceVelocity<dim>::NodalForce sum{};
    for (unsigned int q = 0; q < cells[k].surface_weights.size(); ++q)
    {
      const auto [weight, dilatational_weight] = weights(cells[k], k, q);
      const Tensor<1, dim> &n = cells[k].normals[q];
      TensorLagrange<dim, 3>::evaluate(cells[k].surface_points[q], values, gradients);
      Tensor<1, dim> slope; // of the normal component, with the normal of this point
      double divergence = 0.;
      for (unsigned int i = 0; i < gradients.size(); ++i)
      {
        const Tensor<1, dim> &u = parameters.old_velocity[k][i];
        const Tensor<1, dim> gradient = gradients[i] - (gradients[i] * n) * n;
        slope += (u * n) * gradient;
        divergence += u * gradient;
      }
      slope /= cells[k].size;
      divergence *= dilatational_weight / cells[k].size;
      const auto &test_gradients = interface_velocity.tangential_gradient(k, q);
      for (unsigned int i = 0; i < sum.size(); ++i)
        sum[i] += (weight * (test_gradients[i] * slope)) * n + divergence * test_gradients[i];
    }
    interface_velocity.scatter(k, sum, context.system, right_side);
  }
}

template class SemiImplicitTension<2>;
template class SemiImplicitTension<3>;
} // namespace Gemmule
