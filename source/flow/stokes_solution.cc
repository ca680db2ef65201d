// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/stokes_solution.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>

#include <algorithm>
#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  /** 2 D(u):D(u) in unit coordinates at a point. */
  template <int dim>
  double strain_rate_squared(const std::array<double, StokesLayout<dim>::n> &u,
                             const typename StokesLayout<dim>::VelocityBasis::Gradients &gradients)
  {
    Tensor<2, dim> g;
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int i = 0; i < StokesLayout<dim>::n_velocity_nodes; ++i)
        g[c] += u[StokesLayout<dim>::velocity(c, i)] * gradients[i];
    return scalar_product(g, g) + scalar_product(g, transpose(g));
  }
} // namespace

template <int dim>
void StokesSolution<dim>::reinit(const UnfittedStokesSpace<dim> &new_space,
                                 const CutGeometry<dim> &new_geometry,
                                 const StokesAssembler<dim> &new_assembler, const LinearSystem &system,
                                 const LinearSystem::Vector &unknowns)
{
  space = &new_space;
  geometry = &new_geometry;
  assembler = &new_assembler;

  const auto &cells = assembler->cell_elements();
  local.resize(cells.size());
  for (unsigned int k = 0; k < cells.size(); ++k)
  {
    const bool outside = cells[k].location == CellLocation::outside;
    if (cells[k].location != CellLocation::cut)
      local[k][outside ? 0 : 1].fill(0.);
    // The copies of a cut cell follow one another in its element.
    std::array<double, 2 * Layout::n> both;
    system.gather(cells[k].element, unknowns, both.data());
    if (cells[k].location == CellLocation::cut)
      for (unsigned int fluid = 0; fluid < 2; ++fluid)
        std::copy_n(both.begin() + fluid * Layout::n, Layout::n, local[k][fluid].begin());
    else
      std::copy_n(both.begin(), Layout::n, local[k][outside ? 1 : 0].begin());
  }

  double volume = 0.;
  for (const auto &c : cells)
    volume += std::pow(space->cell_size(c.cell), dim);
  const double mean_pressure = Utilities::MPI::sum(integrate_pressure(), space->communicator()) /
                               Utilities::MPI::sum(volume, space->communicator());
  for (auto &fluids : local)
    for (auto &values : fluids)
      for (unsigned int j = 0; j < Layout::n_pressure_nodes; ++j)
        values[Layout::pressure(j)] -= mean_pressure;
}

template <int dim>
double StokesSolution<dim>::integrate_pressure() const
{
  const auto &cells = assembler->cell_elements();
  double integral = 0.;
  for (unsigned int k = 0; k < cells.size(); ++k)
    if (cells[k].location == CellLocation::cut)
    {
      const CutCell<dim> &cell = *geometry->find(cells[k].cell);
      typename Layout::PressureBasis::Values psi;
      for (unsigned int fluid = 0; fluid < 2; ++fluid)
        for (unsigned int q = 0; q < cell.bulk_points[fluid].size(); ++q)
        {
          Layout::PressureBasis::evaluate(cell.bulk_points[fluid][q], psi);
          for (unsigned int j = 0; j < Layout::n_pressure_nodes; ++j)
            integral += cell.bulk_weights[fluid][q] * psi[j] * local[k][fluid][Layout::pressure(j)];
        }
    }
    else
    {
      const Local &values = local[k][cells[k].location == CellLocation::inside ? 0 : 1];
      double sum = 0.;
      for (unsigned int j = 0; j < Layout::n_pressure_nodes; ++j)
        sum += values[Layout::pressure(j)];
      integral += std::pow(space->cell_size(cells[k].cell), dim) * sum / Layout::n_pressure_nodes;
    }
  return integral;
}

template <int dim>
double StokesSolution<dim>::viscous_dissipation(const double capillary_number) const
{
  const QGauss<dim> quadrature(3);
  typename Layout::VelocityBasis::Values phi;
  std::vector<typename Layout::VelocityBasis::Gradients> gradients(quadrature.size());
  for (unsigned int q = 0; q < quadrature.size(); ++q)
    Layout::VelocityBasis::evaluate(quadrature.point(q), phi, gradients[q]);

  const auto &viscosity = assembler->fluids().viscosity;
  const auto &cells = assembler->cell_elements();
  double dissipation = 0.;
  for (unsigned int k = 0; k < cells.size(); ++k)
  {
    const double h = space->cell_size(cells[k].cell);
    if (cells[k].location == CellLocation::cut)
    {
      const CutCell<dim> &cell = *geometry->find(cells[k].cell);
      typename Layout::VelocityBasis::Gradients grad_phi;
      for (unsigned int fluid = 0; fluid < 2; ++fluid)
        for (unsigned int q = 0; q < cell.bulk_points[fluid].size(); ++q)
        {
          Layout::VelocityBasis::evaluate(cell.bulk_points[fluid][q], phi, grad_phi);
          dissipation += viscosity[fluid] * cell.bulk_weights[fluid][q] *
                         strain_rate_squared<dim>(local[k][fluid], grad_phi) / (h * h);
        }
    }
    else
    {
      const unsigned int fluid = cells[k].location == CellLocation::inside ? 0 : 1;
      for (unsigned int q = 0; q < quadrature.size(); ++q)
        dissipation += viscosity[fluid] * quadrature.weight(q) * std::pow(h, dim - 2) *
                       strain_rate_squared<dim>(local[k][fluid], gradients[q]);
    }
  }
  return capillary_number * Utilities::MPI::sum(dissipation, space->communicator());
}

template <int dim>
std::array<unsigned char, StokesLayout<dim>::n>
StokesSolution<dim>::fluid_at_nodes(const CutCell<dim> &cell) const
{
  using LevelSetBasis = typename CutCell<dim>::LevelSetBasis;
  std::array<unsigned char, Layout::n> fluid;
  for (unsigned int i = 0; i < Layout::n_velocity_nodes; ++i)
  {
    const bool outside = LevelSetBasis::value(cell.level_set, Layout::VelocityBasis::node(i)) >= 0.;
    for (unsigned int c = 0; c < dim; ++c)
      fluid[Layout::velocity(c, i)] = outside;
  }
  for (unsigned int j = 0; j < Layout::n_pressure_nodes; ++j)
    fluid[Layout::pressure(j)] = LevelSetBasis::value(cell.level_set, Layout::PressureBasis::node(j)) >= 0.;
  return fluid;
}

template <int dim>
double StokesSolution<dim>::max_velocity() const
{
  const auto &cells = assembler->cell_elements();
  double largest = 0.;
  for (unsigned int k = 0; k < cells.size(); ++k)
  {
    std::array<unsigned char, Layout::n> fluid;
    fluid.fill(cells[k].location == CellLocation::outside);
    if (cells[k].location == CellLocation::cut)
      fluid = fluid_at_nodes(*geometry->find(cells[k].cell));
    for (unsigned int i = 0; i < Layout::n_velocity_nodes; ++i)
    {
      double square = 0.;
      for (unsigned int c = 0; c < dim; ++c)
      {
        const unsigned int dof = Layout::velocity(c, i);
        square += local[k][fluid[dof]][dof] * local[k][fluid[dof]][dof];
      }
      largest = std::max(largest, square);
    }
  }
  return std::sqrt(Utilities::MPI::max(largest, space->communicator()));
}

template <int dim>
void StokesSolution<dim>::interpolate(Vector &values) const
{
  const auto &handler = space->dof_handler();
  IndexSet relevant;
  DoFTools::extract_locally_relevant_dofs(handler, relevant);
  values.reinit(handler.locally_owned_dofs(), relevant, space->communicator());
  const auto &cells = assembler->cell_elements();
  for (unsigned int k = 0; k < cells.size(); ++k)
  {
    std::array<unsigned char, Layout::n> fluid;
    fluid.fill(cells[k].location == CellLocation::outside);
    if (cells[k].location == CellLocation::cut)
      fluid = fluid_at_nodes(*geometry->find(cells[k].cell));
    const auto &dofs = space->cell_dofs(cells[k].cell);
    for (unsigned int i = 0; i < Layout::n; ++i)
      if (handler.locally_owned_dofs().is_element(dofs[i]))
        values(dofs[i]) = local[k][fluid[i]][i];
  }
  values.update_ghost_values();
}

template class StokesSolution<2>;
template class StokesSolution<3>;
} // namespace Gemmule
