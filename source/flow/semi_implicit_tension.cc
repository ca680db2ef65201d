// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/semi_implicit_tension.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

template <int dim>
void SemiImplicitTension<dim>::add_matrix(const CutGeometry<dim> &geometry, const MembraneForce<dim> &force,
                                          const double capillary_number, const FluidPair &fluids,
                                          const std::vector<StokesCellElement> &cut_cell_elements,
                                          ElementSystem &system, std::vector<double> &rhs) const
{
  using Layout = StokesLayout<dim>;
  constexpr unsigned int nv = Layout::n_velocity_nodes;
  const auto &cells = geometry.cut_cells();
  FullMatrix<double> local(2 * Layout::n, 2 * Layout::n);
  for (unsigned int k = 0; k < cells.size(); ++k)
  {
    // [i][j][c][d]: int sigma n_c n_d grad_s phi_i . grad_s phi_j + E (grad_s phi_i)_c (grad_s phi_j)_d
    std::array<std::array<Tensor<2, dim>, nv>, nv> stiffness{};
    for (unsigned int q = 0; q < cells[k].surface_weights.size(); ++q)
    {
      const double weight =
          coefficient / capillary_number * cells[k].surface_weights[q] * std::max((*tension)[k][q], 0.);
      const double dilatational_weight =
          dilatational_modulus != nullptr
              ? coefficient / capillary_number * cells[k].surface_weights[q] * (*dilatational_modulus)[k][q]
              : 0.;
      const Tensor<2, dim> nn = outer_product(cells[k].normals[q], cells[k].normals[q]);
      const auto &gradients = force.tangential_gradient(k, q);
      for (unsigned int i = 0; i < nv; ++i)
        for (unsigned int j = 0; j <= i; ++j)
          stiffness[i][j] += (weight * (gradients[i] * gradients[j])) * nn +
                             dilatational_weight * outer_product(gradients[i], gradients[j]);
    }
    for (unsigned int i = 0; i < nv; ++i)
      for (unsigned int j = 0; j < nv; ++j)
      {
        const Tensor<2, dim> block = j <= i ? stiffness[i][j] : transpose(stiffness[j][i]);
        for (unsigned int f = 0; f < 2; ++f)
          for (unsigned int g = 0; g < 2; ++g)
            for (unsigned int c = 0; c < dim; ++c)
              for (unsigned int d = 0; d < dim; ++d)
                local(f * Layout::n + Layout::velocity(c, i), g * Layout::n + Layout::velocity(d, j)) =
                    fluids.velocity_weight[f] * fluids.velocity_weight[g] * block[c][d];
      }
    system.add_matrix(cut_cell_elements[k].element, local);
    system.add_inhomogeneity(cut_cell_elements[k].element, local, rhs);
  }
}

template <int dim>
void SemiImplicitTension<dim>::add_rhs(const CutGeometry<dim> &geometry, const MembraneForce<dim> &force,
                                       const double capillary_number, const FluidPair &fluids,
                                       const std::vector<StokesCellElement> &cut_cell_elements,
                                       const ElementSystem &system, std::vector<double> &rhs) const
{
  using Layout = StokesLayout<dim>;
  constexpr unsigned int nv = Layout::n_velocity_nodes;
  const auto &cells = geometry.cut_cells();
  std::array<double, 2 * Layout::n> local;
  typename TensorLagrange<dim, 3>::Values values;
  typename TensorLagrange<dim, 3>::Gradients gradients;
  for (unsigned int k = 0; k < cells.size(); ++k)
  {
    std::array<Tensor<1, dim>, nv> sum{};
    for (unsigned int q = 0; q < cells[k].surface_weights.size(); ++q)
    {
      const double weight =
          coefficient / capillary_number * cells[k].surface_weights[q] * std::max((*tension)[k][q], 0.);
      const double dilatational_weight =
          dilatational_modulus != nullptr
              ? coefficient / capillary_number * cells[k].surface_weights[q] * (*dilatational_modulus)[k][q]
              : 0.;
      const Tensor<1, dim> &n = cells[k].normals[q];
      TensorLagrange<dim, 3>::evaluate(cells[k].surface_points[q], values, gradients);
      Tensor<1, dim> slope; // of the normal component, with the normal of this point
      double divergence = 0.;
      for (unsigned int i = 0; i < gradients.size(); ++i)
      {
        const Tensor<1, dim> &u = (*old_velocity)[k][i];
        const Tensor<1, dim> gradient = gradients[i] - (gradients[i] * n) * n;
        slope += (u * n) * gradient;
        divergence += u * gradient;
      }
      slope /= cells[k].size;
      divergence *= dilatational_weight / cells[k].size;
      const auto &test_gradients = force.tangential_gradient(k, q);
      for (unsigned int i = 0; i < nv; ++i)
        sum[i] += (weight * (test_gradients[i] * slope)) * n + divergence * test_gradients[i];
    }
    local.fill(0.);
    for (unsigned int f = 0; f < 2; ++f)
      for (unsigned int i = 0; i < nv; ++i)
        for (unsigned int c = 0; c < dim; ++c)
          local[f * Layout::n + Layout::velocity(c, i)] = fluids.velocity_weight[f] * sum[i][c];
    system.add_rhs(cut_cell_elements[k].element, local.data(), rhs);
  }
}

template struct SemiImplicitTension<2>;
template struct SemiImplicitTension<3>;
} // namespace Gemmule
