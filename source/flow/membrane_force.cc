// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/membrane_force.h>

namespace Gemmule
{
using namespace dealii;

template <int dim>
void MembraneForce<dim>::reinit(const CutGeometry<dim> &new_geometry)
{
  geometry = &new_geometry;
  first_point.clear();
  tangential_gradients.clear();
  typename Layout::VelocityBasis::Values phi;
  typename Layout::VelocityBasis::Gradients grad_phi;
  for (const CutCell<dim> &cell : geometry->cut_cells())
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
void MembraneForce<dim>::add_rhs(const MembranePointValues *tension, const double offset,
                                 const double capillary_number, const FluidPair &fluids,
                                 const std::vector<StokesCellElement> &cut_cell_elements,
                                 const ElementSystem &system, std::vector<double> &rhs) const
{
  const auto &cells = geometry->cut_cells();
  std::array<double, 2 * Layout::n> local;
  for (unsigned int k = 0; k < cells.size(); ++k)
  {
    // div_s (phi_i e_c) is component c of the tangential gradient.
    std::array<Tensor<1, dim>, nv> force{};
    for (unsigned int q = 0; q < cells[k].surface_weights.size(); ++q)
    {
      const double sigma = (tension != nullptr ? (*tension)[k][q] : 0.) + offset;
      const auto &gradients = tangential_gradients[first_point[k] + q];
      for (unsigned int i = 0; i < nv; ++i)
        force[i] -= (cells[k].surface_weights[q] * sigma / capillary_number) * gradients[i];
    }
    local.fill(0.);
    for (unsigned int fluid = 0; fluid < 2; ++fluid)
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int i = 0; i < nv; ++i)
          local[fluid * Layout::n + Layout::velocity(c, i)] = fluids.velocity_weight[fluid] * force[i][c];
    system.add_rhs(cut_cell_elements[k].element, local.data(), rhs);
  }
}

template <int dim>
typename MembraneForce<dim>::Velocity
MembraneForce<dim>::average(const FluidPair &fluids, const std::vector<StokesCellElement> &cut_cell_elements,
                            const ElementSystem &system, const std::vector<double> &unknowns,
                            const bool homogeneous) const
{
  Velocity velocity(cut_cell_elements.size());
  std::array<double, 2 * Layout::n> local;
  for (unsigned int k = 0; k < velocity.size(); ++k)
  {
    system.element(cut_cell_elements[k].element).gather(unknowns, local.data(), homogeneous);
    velocity[k].cell_size = geometry->cut_cells()[k].size;
    for (unsigned int i = 0; i < nv; ++i)
      for (unsigned int c = 0; c < dim; ++c)
        velocity[k].nodal[i][c] = fluids.velocity_weight[0] * local[Layout::velocity(c, i)] +
                                  fluids.velocity_weight[1] * local[Layout::n + Layout::velocity(c, i)];
  }
  return velocity;
}

template <int dim>
double MembraneForce<dim>::integrate_divergence(const MembranePointValues *tension, const double offset,
                                                const Velocity &velocity) const
{
  const auto &cells = geometry->cut_cells();
  double integral = 0.;
  for (unsigned int k = 0; k < cells.size(); ++k)
    for (unsigned int q = 0; q < cells[k].surface_weights.size(); ++q)
    {
      const auto &gradients = tangential_gradients[first_point[k] + q];
      double divergence = 0.;
      for (unsigned int i = 0; i < nv; ++i)
        divergence += velocity[k].nodal[i] * gradients[i];
      const double sigma = (tension != nullptr ? (*tension)[k][q] : 0.) + offset;
      integral += cells[k].surface_weights[q] * sigma * divergence;
    }
  return integral;
}

template <int dim>
double MembraneForce<dim>::integrate_flux(const Velocity &velocity) const
{
  const auto &cells = geometry->cut_cells();
  double integral = 0.;
  for (unsigned int k = 0; k < cells.size(); ++k)
    for (unsigned int q = 0; q < cells[k].surface_weights.size(); ++q)
      integral +=
          cells[k].surface_weights[q] * (velocity[k].value(cells[k].surface_points[q]) * cells[k].normals[q]);
  return integral;
}

template class MembraneForce<2>;
template class MembraneForce<3>;
} // namespace Gemmule
