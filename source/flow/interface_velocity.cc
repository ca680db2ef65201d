// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/interface_velocity.h>

namespace Gemmule
{
using namespace dealii;

template <int dim>
void InterfaceVelocity<dim>::reinit(const CutGeometry<dim> &new_geometry)
{
  cut_geometry = &new_geometry;
  first_point.clear();
  tangential_gradients.clear();
  typename Layout::VelocityBasis::Values phi;
  typename Layout::VelocityBasis::Gradients grad_phi;
  for (const CutCell<dim> &cell : cut_geometry->cut_cells())
  {
    first_point.push_back(tangential_gradients.size());
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      Layout::VelocityBasis::evaluate(cell.surface_points[q], phi, grad_phi);
      const Tensor<1, dim> &normal = cell.normals[q];
      for (auto &gradient : grad_phi)
        gradient = (gradient - (gradient * normal) * normal) / cell.size;
      tangential_gradients.push_back(grad_phi);
    }
  }
}

template <int dim>
void InterfaceVelocity<dim>::connect(const FluidPair &fluids, const std::vector<unsigned int> &new_elements)
{
  AssertDimension(new_elements.size(), cut_geometry->cut_cells().size());
  weights = fluids.velocity_weight;
  elements = new_elements;
}

template <int dim>
typename InterfaceVelocity<dim>::Velocity InterfaceVelocity<dim>::gather(const LinearSystem &system,
                                                                         const Vector &solution,
                                                                         const bool homogeneous) const
{
  Velocity velocity(elements.size());
  std::array<double, 2 * Layout::n> local;
  for (unsigned int k = 0; k < velocity.size(); ++k)
  {
    system.gather(elements[k], solution, local.data(), homogeneous);
    velocity[k].cell_size = cut_geometry->cut_cells()[k].size;
    for (unsigned int i = 0; i < n_nodes; ++i)
      for (unsigned int c = 0; c < dim; ++c)
        velocity[k].nodal[i][c] = weights[0] * local[Layout::velocity(c, i)] +
                                  weights[1] * local[Layout::n + Layout::velocity(c, i)];
  }
  return velocity;
}

template <int dim>
void InterfaceVelocity<dim>::scatter(const unsigned int k, const NodalForce &force,
                                     const LinearSystem &system, Vector &right_side) const
{
  std::array<double, 2 * Layout::n> local;
  local.fill(0.);
  for (unsigned int fluid = 0; fluid < 2; ++fluid)
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int i = 0; i < n_nodes; ++i)
        local[fluid * Layout::n + Layout::velocity(c, i)] = weights[fluid] * force[i][c];
  system.add_right_side(elements[k], local.data(), right_side);
}

template <int dim>
void InterfaceVelocity<dim>::add_matrix(const unsigned int k, const NodalMatrix &form, LinearSystem &system,
                                        Vector &right_side) const
{
  if (scratch.empty())
    scratch.reinit(2 * Layout::n, 2 * Layout::n); // all but the velocities stays zero
  for (unsigned int i = 0; i < n_nodes; ++i)
    for (unsigned int j = 0; j < n_nodes; ++j)
      for (unsigned int f = 0; f < 2; ++f)
        for (unsigned int g = 0; g < 2; ++g)
          for (unsigned int c = 0; c < dim; ++c)
            for (unsigned int d = 0; d < dim; ++d)
              scratch(f * Layout::n + Layout::velocity(c, i), g * Layout::n + Layout::velocity(d, j)) =
                  weights[f] * weights[g] * form[i][j][c][d];
  system.add_matrix(elements[k], scratch);
  system.add_inhomogeneity(elements[k], scratch, right_side);
}

template <int dim>
double InterfaceVelocity<dim>::integrate_divergence(const MembranePointValues *const sigma,
                                                    const Velocity &velocity) const
{
  const auto &cells = cut_geometry->cut_cells();
  double integral = 0.;
  for (unsigned int k = 0; k < cells.size(); ++k)
    for (unsigned int q = 0; q < cells[k].surface_weights.size(); ++q)
    {
      const auto &gradients = tangential_gradient(k, q);
      double divergence = 0.;
      for (unsigned int i = 0; i < n_nodes; ++i)
        divergence += velocity[k].nodal[i] * gradients[i];
      integral += cells[k].surface_weights[q] * (sigma != nullptr ? (*sigma)[k][q] : 1.) * divergence;
    }
  return integral;
}

template <int dim>
double InterfaceVelocity<dim>::integrate_flux(const Velocity &velocity) const
{
  const auto &cells = cut_geometry->cut_cells();
  double integral = 0.;
  for (unsigned int k = 0; k < cells.size(); ++k)
    for (unsigned int q = 0; q < cells[k].surface_weights.size(); ++q)
      integral +=
          cells[k].surface_weights[q] * (velocity[k].value(cells[k].surface_points[q]) * cells[k].normals[q]);
  return integral;
}

template class InterfaceVelocity<2>;
template class InterfaceVelocity<3>;
} // namespace Gemmule
