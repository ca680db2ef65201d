// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/base/raise_together.h>
#include <gemmule/flow/boundary_velocity.h>
#include <gemmule/parameters/expression.h>
#include <gemmule/parameters/text.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <cmath>
#include <map>

namespace Gemmule
{
using namespace dealii;

template <int dim>
void BoundaryVelocity<dim>::reinit(const DoFHandler<dim> &dof_handler,
                                   const AffineConstraints<double> &hanging_nodes)
{
  using Layout = StokesLayout<dim>;
  communicator = dof_handler.get_communicator();
  boundary_dofs.clear();

  std::array<std::vector<unsigned int>, dim> lexicographic;
  for (unsigned int c = 0; c < dim; ++c)
    lexicographic[c] = lexicographic_cell_dofs(dof_handler.get_fe(), c);

  IndexSet relevant;
  DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
  LinearAlgebra::distributed::Vector<double> weights(dof_handler.locally_owned_dofs(), relevant,
                                                     communicator);

  // Simpson's rule integrates the trace of Q2 exactly; its weight of a node is the product over the tangents.
  constexpr std::array<double, 3> simpson{{1. / 6., 4. / 6., 1. / 6.}};
  std::map<types::global_dof_index, BoundaryDof> found;
  std::vector<types::global_dof_index> dofs(dof_handler.get_fe().n_dofs_per_cell());
  for (const auto &cell : dof_handler.active_cell_iterators())
  {
    if (cell->is_artificial() || !cell->at_boundary())
      continue;
    cell->get_dof_indices(dofs);
    const double h = cell->extent_in_direction(0);
    for (const unsigned int face : cell->face_indices())
    {
      if (!cell->at_boundary(face))
        continue;
      const unsigned int direction = face / 2;
      const double side = face % 2;
      std::vector<types::global_dof_index> flux_dofs;
      std::vector<double> flux_values;
      for (unsigned int i = 0; i < Layout::n_velocity_nodes; ++i)
      {
        const Point<dim> node = Layout::VelocityBasis::node(i);
        if (node[direction] != side)
          continue;
        for (unsigned int c = 0; c < dim; ++c)
        {
          const auto dof = dofs[lexicographic[c][i]];
          const bool owned = dof_handler.locally_owned_dofs().is_element(dof);
          if (!hanging_nodes.is_constrained(dof))
            found[dof] = {dof, c, cell->vertex(0) + h * Tensor<1, dim>(node), 0., owned};
        }
        double weight = (side > 0. ? 1. : -1.) * std::pow(h, dim - 1);
        for (unsigned int d = 0; d < dim; ++d)
          if (d != direction)
            weight *= simpson[static_cast<unsigned int>(2. * node[d] + 0.5)];
        flux_dofs.push_back(dofs[lexicographic[direction][i]]);
        flux_values.push_back(weight);
      }
      // Hanging nodes pass their share of the flux on to their masters.
      if (cell->is_locally_owned())
        hanging_nodes.distribute_local_to_global(flux_values, flux_dofs, weights);
    }
  }
  weights.compress(VectorOperation::add);
  weights.update_ghost_values();

  double measure = 0.;
  boundary_dofs.reserve(found.size());
  for (auto &entry : found)
  {
    entry.second.flux_weight = weights(entry.first);
    if (entry.second.owned)
      measure += std::abs(entry.second.flux_weight);
    boundary_dofs.push_back(entry.second);
  }
  boundary_measure = Utilities::MPI::sum(measure, communicator);
}

template <int dim>
void BoundaryVelocity<dim>::constrain(const Function<dim> &velocity, AffineConstraints<double> &constraints)
{
  AssertDimension(velocity.n_components, dim);
  const std::string parameter = "Domain/Boundary velocity";
  std::string complaint;
  std::vector<double> values(boundary_dofs.size());
  std::array<double, 2> sums{{0., 0.}};
  for (unsigned int i = 0; i < values.size(); ++i)
  {
    const auto &b = boundary_dofs[i];
    values[i] = velocity.value(b.point, b.component);
    if (!std::isfinite(values[i]) && complaint.empty())
      complaint = not_finite_complaint<dim>(velocity, {b.point});
    if (b.owned)
    {
      sums[0] += b.flux_weight * values[i];
      sums[1] += std::abs(b.flux_weight * values[i]);
    }
  }
  raise_together(parameter, complaint, communicator);
  // All ranks see the same sums from here on, and throw together.
  const double total = Utilities::MPI::sum(sums[1], communicator);
  flux = Utilities::MPI::sum(sums[0], communicator);
  if (!std::isfinite(total))
    throw ParameterError(parameter, "the velocity at the walls is too large to compute with at t = " +
                                        Parameters::short_number(velocity.get_time()) +
                                        ": its flux is no finite number. Give a smaller one.");
  if (std::abs(flux) > 0.05 * total + 1e-14)
    throw ParameterError(
        parameter, "the flow at the walls pumps fluid into or out of the box (net flux " +
                       std::to_string(flux) + " at t = " + Parameters::short_number(velocity.get_time()) +
                       "), which an incompressible fluid cannot do. Give a velocity of zero divergence, "
                       "for example '0.5*y; 0'.");

  const double correction = flux / boundary_measure;
  for (unsigned int i = 0; i < values.size(); ++i)
  {
    const auto &b = boundary_dofs[i];
    if (b.flux_weight != 0.)
      values[i] -= b.flux_weight > 0. ? correction : -correction;
    constraints.add_line(b.dof);
    constraints.set_inhomogeneity(b.dof, values[i]);
  }
}

template class BoundaryVelocity<2>;
template class BoundaryVelocity<3>;
} // namespace Gemmule
