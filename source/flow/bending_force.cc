// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/bending_force.h>
#include <gemmule/surface/trace_forms.h>

namespace Gemmule
{
using namespace dealii;

namespace
{
  /** w I - m grad_s n, on tangential vectors. */
  template <int dim>
  SymmetricTensor<2, dim> tangential_stress(const CutCell<dim> &cell, const unsigned int q,
                                            const double curvature, const double moment, const double energy)
  {
    SymmetricTensor<2, dim> stress = (energy - moment * curvature / (dim - 1)) * unit_symmetric_tensor<dim>();
    if constexpr (dim == 3)
    {
      const auto phi = evaluate_polynomial<dim, 3, 2>(cell.level_set, cell.surface_points[q]);
      const Tensor<1, dim> &n = cell.normals[q];
      Tensor<2, dim> projection;
      for (unsigned int d = 0; d < dim; ++d)
        projection[d][d] = 1.;
      projection -= outer_product(n, n);
      const Tensor<2, dim> shape =
          projection * Tensor<2, dim>(phi.hessian) * projection / (phi.gradient.norm() * cell.size);
      stress -= moment * symmetrize(shape - 0.5 * trace(shape) * projection);
    }
    else
      (void)cell, (void)q;
    return stress;
  }
} // namespace

template <int dim>
BendingForce<dim>::BendingForce(const MembraneBending<dim> &bending, const CutGeometry<dim> &geometry)
    : bending(bending), geometry(geometry)
{
}

template <int dim>
std::array<Tensor<1, dim>, BendingForce<dim>::nv>
BendingForce<dim>::variation(const MembraneForce<dim> &force, const unsigned int k) const
{
  const CutCell<dim> &cell = geometry.cut_cells()[k];
  std::array<Tensor<1, dim>, nv> result{};
  SurfacePoint<dim> point;
  for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
  {
    point.reinit(cell, q);
    const Tensor<1, dim> slope = cell.surface_weights[q] * point.surface_gradient(bending.moment()[k]);
    const SymmetricTensor<2, dim> stress =
        cell.surface_weights[q] * tangential_stress(cell, q, bending.curvature()[k][q],
                                                    bending.moment_at_points()[k][q],
                                                    bending.energy_density()[k][q]);
    const auto &gradients = force.tangential_gradient(k, q);
    for (unsigned int i = 0; i < nv; ++i)
      result[i] += (slope * gradients[i]) * cell.normals[q] + stress * gradients[i];
  }
  return result;
}

template <int dim>
void BendingForce<dim>::add_rhs(const MembraneForce<dim> &force, const double capillary_number,
                                const FluidPair &fluids,
                                const std::vector<StokesCellElement> &cut_cell_elements,
                                const ElementSystem &system, std::vector<double> &rhs) const
{
  using Layout = StokesLayout<dim>;
  std::array<double, 2 * Layout::n> local;
  for (unsigned int k = 0; k < cut_cell_elements.size(); ++k)
  {
    const auto derivative = variation(force, k);
    local.fill(0.);
    for (unsigned int fluid = 0; fluid < 2; ++fluid)
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int i = 0; i < nv; ++i)
          local[fluid * Layout::n + Layout::velocity(c, i)] =
              -fluids.velocity_weight[fluid] / capillary_number * derivative[i][c];
    system.add_rhs(cut_cell_elements[k].element, local.data(), rhs);
  }
}

template <int dim>
double BendingForce<dim>::power(const MembraneForce<dim> &force, const Velocity &velocity) const
{
  double sum = 0.;
  for (unsigned int k = 0; k < velocity.size(); ++k)
  {
    const auto derivative = variation(force, k);
    for (unsigned int i = 0; i < nv; ++i)
      sum += derivative[i] * velocity[k].nodal[i];
  }
  return sum;
}

template class BendingForce<2>;
template class BendingForce<3>;
} // namespace Gemmule
