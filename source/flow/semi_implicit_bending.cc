// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/semi_implicit_bending.h>
#include <gemmule/surface/trace_forms.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
void SemiImplicitBending<dim>::add_elements(const unsigned int first_unknown,
                                            const std::vector<StokesCellElement> &cut_cell_elements,
                                            ElementSystem &system)
{
  elements.assign(cut_cell_elements.size(), 0);
  for (unsigned int b = 0; b < space->active_mesh().size(); ++b)
  {
    const unsigned int k = space->active_mesh()[b].cut_index;
    CondensedIndices element = system.element(cut_cell_elements[k].element);
    const CondensedIndices &trace = space->elements()[b];
    const unsigned int n_flow_indices = element.indices.size(), n_flow_entries = element.entries.size();
    for (const auto index : trace.indices)
      element.indices.push_back(first_unknown + index);
    for (const auto &[position, weight] : trace.entries)
      element.entries.emplace_back(n_flow_indices + position, weight);
    for (unsigned int i = 0; i < trace.n_local(); ++i)
    {
      element.row_start.push_back(n_flow_entries + trace.row_start[i + 1]);
      element.inhomogeneities.push_back(trace.inhomogeneities[i]);
    }
    elements[k] = system.add_element(std::move(element));
  }
}

template <int dim>
void SemiImplicitBending<dim>::add_matrix(const CutGeometry<dim> &geometry, const MembraneForce<dim> &force,
                                          const double capillary_number, const FluidPair &fluids,
                                          ElementSystem &system, std::vector<double> &rhs) const
{
  using Layout = StokesLayout<dim>;
  constexpr unsigned int nv = Layout::n_velocity_nodes, nt = TraceSpace<dim>::Basis::n, first = 2 * Layout::n;
  const double scale = std::sqrt(coefficient / capillary_number);
  FullMatrix<double> local(first + nt, first + nt);
  SurfacePoint<dim> point;
  for (const TraceCell<dim> &trace_cell : space->active_mesh())
  {
    const unsigned int k = trace_cell.cut_index;
    const CutCell<dim> &cell = geometry.cut_cells()[k];
    std::array<std::array<Tensor<1, dim>, nt>, nv> coupling{};
    local = 0.;
    for (unsigned int i = 0; i < nt; ++i)
      for (unsigned int j = 0; j < nt; ++j)
        local(first + i, first + j) = -cell.size * trace_cell.normal_derivatives(i, j);
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      point.reinit(cell, q);
      const double weight = cell.surface_weights[q];
      const auto &gradients = force.tangential_gradient(k, q);
      for (unsigned int j = 0; j < nt; ++j)
      {
        for (unsigned int i = 0; i < nt; ++i)
          local(first + i, first + j) -= weight * point.values[i] * point.values[j];
        for (unsigned int i = 0; i < nv; ++i)
          coupling[i][j] += (weight * scale * (gradients[i] * point.surface_gradients[j])) * cell.normals[q];
      }
    }
    for (unsigned int fluid = 0; fluid < 2; ++fluid)
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int i = 0; i < nv; ++i)
          for (unsigned int j = 0; j < nt; ++j)
          {
            const unsigned int row = fluid * Layout::n + Layout::velocity(c, i);
            local(row, first + j) = local(first + j, row) = fluids.velocity_weight[fluid] * coupling[i][j][c];
          }
    system.add_matrix(elements[k], local);
    system.add_inhomogeneity(elements[k], local, rhs);
  }
}

template <int dim>
void SemiImplicitBending<dim>::add_rhs(const CutGeometry<dim> &geometry, const double capillary_number,
                                       const ElementSystem &system, std::vector<double> &rhs) const
{
  constexpr unsigned int nt = TraceSpace<dim>::Basis::n;
  const double scale = std::sqrt(coefficient / capillary_number);
  ElementSystem mass(space->communicator(), true), filter(space->communicator(), true);
  begin_system(*space, 1, mass);
  begin_system(*space, 1, filter);
  mass.zero_matrix();
  filter.zero_matrix();

  std::vector<double> old(space->n_unknowns(), 0.);
  std::array<double, nt> local;
  FullMatrix<double> matrix(nt, nt), stiffness(nt, nt);
  typename TensorLagrange<dim, 3>::Values values;
  typename TensorLagrange<dim, 3>::Gradients gradients;
  SurfacePoint<dim> point;
  for (unsigned int b = 0; b < space->active_mesh().size(); ++b)
  {
    const TraceCell<dim> &trace_cell = space->active_mesh()[b];
    const unsigned int k = trace_cell.cut_index;
    const CutCell<dim> &cell = geometry.cut_cells()[k];
    local.fill(0.);
    stabilised_mass_matrix(trace_cell, matrix);
    stiffness = 0.;
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      point.reinit(cell, q);
      const double weight = cell.surface_weights[q];
      const Tensor<1, dim> &n = cell.normals[q];
      TensorLagrange<dim, 3>::evaluate(cell.surface_points[q], values, gradients);
      Tensor<1, dim> slope; // (grad u_old)^T n; the shapes' gradients are tangential
      for (unsigned int i = 0; i < gradients.size(); ++i)
        slope += ((*old_velocity)[k][i] * n) * gradients[i];
      slope *= scale * weight / cell.size;
      for (unsigned int i = 0; i < nt; ++i)
      {
        local[i] += slope * point.surface_gradients[i];
        for (unsigned int j = 0; j < nt; ++j)
          stiffness(i, j) += weight * (point.surface_gradients[i] * point.surface_gradients[j]);
      }
    }
    mass.add_matrix(b, matrix);
    matrix.add(cell.size * cell.size, stiffness);
    filter.add_matrix(b, matrix);
    mass.add_rhs(b, local.data(), old);
  }
  filter.factorise();

  // u_old comes from another mesh position, with errors as short as a cell whose second derivatives are
  // large, and the flow would take them over as if they were its own past. Hence z_old is filtered, by 2F -
  // F^2 with F = (1 - h^2 Laplace_s)^{-1}: waves of many cells stay as they are up to (h k)^4, those of a
  // cell have no past.
  std::vector<double> once = old;
  filter.solve(once);
  once = mass.apply_local_part(once);
  std::vector<double> twice = once;
  filter.solve(twice);
  twice = mass.apply_local_part(twice);
  const unsigned int first_unknown = system.n_unknowns() - space->n_unknowns();
  for (unsigned int i = 0; i < once.size(); ++i)
    rhs[first_unknown + i] += 2. * once[i] - twice[i];
}

template struct SemiImplicitBending<2>;
template struct SemiImplicitBending<3>;
} // namespace Gemmule
