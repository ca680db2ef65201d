// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/tension_force.h>

namespace Gemmule
{
template <int dim>
void TensionForce<dim>::add_right_side(const FlowTermContext<dim> &context, Vector &right_side) const
{
  AssertDimension(tension.size(), context.interface_velocity.geometry().cut_cells().size());
  add_tension(context.interface_velocity, context.system, &tension, capillary_number, right_side);
}

template <int dim>
void TensionForce<dim>::add_tension(const InterfaceVelocity<dim> &interface_velocity,
                                    const LinearSystem &system, const MembranePointValues *const sigma,
                                    const double capillary_number, Vector &right_side)
{
  const auto &cells = interface_velocity.geometry().cut_cells();
  for (unsigned int k = 0; k < cells.size(); ++k)
  {
    typename InterfaceVelocity<dim>::NodalForce force{};
    for (unsigned int q = 0; q < cells[k].surface_weights.size(); ++q)
    {
      const double weight =
          cells[k].surface_weights[q] * (sigma != nullptr ? (*sigma)[k][q] : 1.) / capillary_number;
      const auto &gradients = interface_velocity.tangential_gradient(k, q);
      for (unsigned int i = 0; i < force.size(); ++i)
        force[i] -= weight * gradients[i];
    }
    interface_velocity.scatter(k, force, system, right_side);
  }
}

template class TensionForce<2>;
template class TensionForce<3>;
} // namespace Gemmule
