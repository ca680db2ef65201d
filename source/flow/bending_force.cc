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
BendingForce<dim>::BendingForce(const MembraneBending<dim> &bending, const double capillary_number)
    : moment(bending.moment()), curvature(bending.curvature()), moment_at_points(bending.moment_at_points()),
      energy_density(bending.energy_density()), capillary_number(capillary_number)
{
}

template <int dim>
typename BendingForce<dim>::NodalForce
BendingForce<dim>::variation(const InterfaceVelocity<dim> &interface_velocity, const unsigned int k) const
{
  const CutCell<dim> &cell = interface_velocity.geometry().cut_cells()[k];
  NodalForce result{};
  SurfacePoint<dim> point;
  for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
  {
    point.reinit(cell, q);
    const Tensor<1, dim> slope = cell.surface_weights[q] * point.surface_gradient(moment[k]);
    const SymmetricTensor<2, dim> stress =
        cell.surface_weights[q] *
        tangential_stress(cell, q, curvature[k][q], moment_at_points[k][q], energy_density[k][q]);
    const auto &gradients = interface_velocity.tangential_gradient(k, q);
    for (unsigned int i = 0; i < result.size(); ++i)
      result[i] += (slope * gradients[i]) * cell.normals[q] + stress * gradients[i];
  }
  return result;
}

template <int dim>
void BendingForce<dim>::add_right_side(const FlowTermContext<dim> &context, Vector &right_side) const
{
  for (unsigned int k = 0; k < moment.size(); ++k)
  {
    NodalForce force = variation(context.interface_velocity, k);
    for (auto &nodal : force)
      nodal *= -1. / capillary_number;
    context.interface_velocity.scatter(k, force, context.system, right_side);
  }
}

template <int dim>
double BendingForce<dim>::power(const InterfaceVelocity<dim> &interface_velocity,
                                const Velocity &velocity) const
{
  double sum = 0.;
  for (unsigned int k = 0; k < velocity.size(); ++k)
  {
    const auto derivative = variation(interface_velocity, k);
    for (unsigned int i = 0; i < derivative.size(); ++i)
      sum += derivative[i] * velocity[k].nodal[i];
  }
  return sum;
}

template class BendingForce<2>;
template class BendingForce<3>;
} // namespace Gemmule
