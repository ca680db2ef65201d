// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/bending_schur_complement.h>
#include <gemmule/flow/semi_implicit_bending.h>
#include <gemmule/surface/trace_forms.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
SemiImplicitBending<dim>::SemiImplicitBending(const double coefficient,
                                              std::shared_ptr<const TraceSpace<dim>> space,
                                              std::vector<NodalVelocity> old_velocity,
                                              const double capillary_number)
    : scale(std::sqrt(coefficient / capillary_number)), space(std::move(space)),
      old_velocity(std::move(old_velocity))
{
}

template <int dim>
std::unique_ptr<ExtraFieldPreconditioner>
SemiImplicitBending<dim>::extra_field_preconditioner(const FluidPair &fluids) const
{
  const double response = 3. * scale * scale / (numbers::PI * (fluids.viscosity[0] + fluids.viscosity[1]));
  return std::make_unique<BendingSchurComplement<dim>>(*space, response);
}

template <int dim>
void SemiImplicitBending<dim>::add_matrix(const FlowTermContext<dim> &context, Vector &right_side) const
{
  constexpr unsigned int nt = ExtraField<dim>::n, first = ExtraField<dim>::n_flow,
                         nv = InterfaceVelocity<dim>::n_nodes;
  FullMatrix<double> local(first + nt, first + nt);
  SurfacePoint<dim> point;
  for (unsigned int b = 0; b < space->active_mesh().size(); ++b)
  {
    const TraceCell<dim> &trace_cell = space->active_mesh()[b];
    const CutCell<dim> &cell = *trace_cell.cut;
    std::array<std::array<Tensor<1, dim>, nt>, nv> coupling{};
    local = 0.;
    for (unsigned int i = 0; i < nt; ++i)
      for (unsigned int j = 0; j < nt; ++j)
        local(first + i, first + j) = -cell.size * trace_cell.normal_derivatives(i, j);
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      point.reinit(cell, q);
      const double weight = cell.surface_weights[q];
      const auto &gradients = context.interface_velocity.tangential_gradient(trace_cell.cut_index, q);
      for (unsigned int j = 0; j < nt; ++j)
      {
        for (unsigned int i = 0; i < nt; ++i)
          local(first + i, first + j) -= weight * point.values[i] * point.values[j];
        for (unsigned int i = 0; i < nv; ++i)
          coupling[i][j] += (weight * scale * (gradients[i] * point.surface_gradients[j])) * cell.normals[q];
      }
    }
    context.interface_velocity.set_coupling(coupling, local);
    const unsigned int element = context.extra_field->element(b);
    context.system.add_matrix(element, local);
    context.system.add_inhomogeneity(element, local, right_side);
  }
}

template <int dim>
void SemiImplicitBending<dim>::add_right_side(const FlowTermContext<dim> &context, Vector &right_side) const
{
  constexpr unsigned int nt = ExtraField<dim>::n;
  LinearSystem mass(space->communicator(), true), filter(space->communicator(), true);
  begin_system(*space, 1, mass);
  begin_system(*space, 1, filter);
  mass.zero_matrix();
  filter.zero_matrix();

  auto old = mass.make_vector();
  std::array<double, nt> local;
  FullMatrix<double> matrix(nt, nt), stiffness(nt, nt);
  typename TensorLagrange<dim, 3>::Values values;
  typename TensorLagrange<dim, 3>::Gradients gradients;
  SurfacePoint<dim> point;
  for (unsigned int b = 0; b < space->active_mesh().size(); ++b)
  {
    const TraceCell<dim> &trace_cell = space->active_mesh()[b];
    const CutCell<dim> &cell = *trace_cell.cut;
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
        slope += (old_velocity[trace_cell.cut_index][i] * n) * gradients[i];
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
    mass.add_right_side(b, local.data(), old);
  }
  filter.factorise();

  // u_old comes from another mesh position, with errors as short as a cell whose second derivatives are
  // large, and the flow would take them over as if they were its own past. Hence z_old is filtered, by 2F -
  // F^2 with F = (1 - h^2 Laplace_s)^{-1}: waves of many cells stay as they are up to (h k)^4, those of a
  // cell have no past.
  const Vector once = mass.vmult(filter.solve(std::move(old)));
  Vector filtered = mass.vmult(filter.solve(once));
  filtered.sadd(-1., 2., once);
  context.extra_field->add_to(right_side, context.system, filtered);
}

template class SemiImplicitBending<2>;
template class SemiImplicitBending<3>;
} // namespace Gemmule
