// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/geometry/interface.h>
#include <gemmule/surface/membrane_bending.h>
#include <gemmule/surface/trace_forms.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace Gemmule
{
using namespace dealii;

template <int dim>
MembraneBending<dim>::MembraneBending(const Triangulation<dim> &triangulation, const BendingLaw &law)
    : law(law), shared_space(std::make_shared<TraceSpace<dim>>(triangulation)), space(*shared_space),
      system(triangulation.get_communicator(), true)
{
}

template <int dim>
void MembraneBending<dim>::reinit_mesh()
{
  space.reinit_mesh();
}

template <int dim>
void MembraneBending<dim>::assemble_mass_matrix()
{
  constexpr unsigned int n = TraceSpace<dim>::Basis::n;
  begin_system(space, 1, system);
  system.zero_matrix();
  FullMatrix<double> matrix(n, n);
  for (unsigned int k = 0; k < space.active_mesh().size(); ++k)
  {
    stabilised_mass_matrix(space.active_mesh()[k], matrix);
    system.add_matrix(k, matrix);
  }
  system.factorise();
}

template <int dim>
void MembraneBending<dim>::compute_curvature(const Interface<dim> &interface)
{
  const CutGeometry<dim> &geometry = interface.geometry();
  constexpr unsigned int n = TraceSpace<dim>::Basis::n;
  // Without clouds the active mesh consists of the cut cells.
  space.prepare(interface, {{nullptr, nullptr}});
  assemble_mass_matrix();

  std::vector<LinearSystem::Vector> right_sides(dim, system.make_vector()),
      solutions(dim, system.make_vector());
  SurfacePoint<dim> point;
  std::array<std::array<double, n>, dim> local;
  for (unsigned int k = 0; k < space.active_mesh().size(); ++k)
  {
    const CutCell<dim> &cell = *space.active_mesh()[k].cut;
    for (auto &component : local)
      component.fill(0.);
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      point.reinit(cell, q);
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int i = 0; i < n; ++i)
          local[c][i] += cell.surface_weights[q] * point.surface_gradients[i][c];
    }
    for (unsigned int c = 0; c < dim; ++c)
      system.add_right_side(k, local[c].data(), right_sides[c]);
  }
  system.solve(right_sides, solutions);

  curvature_at_points.assign(geometry.cut_cells().size(), {});
  for (unsigned int k = 0; k < curvature_at_points.size(); ++k)
    curvature_at_points[k].assign(geometry.cut_cells()[k].surface_points.size(), 0.);
  for (unsigned int c = 0; c < dim; ++c)
  {
    const TraceField<dim> component = space.extract(system, solutions[c]);
    for (unsigned int k = 0; k < curvature_at_points.size(); ++k)
    {
      const CutCell<dim> &cell = geometry.cut_cells()[k];
      for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
        curvature_at_points[k][q] +=
            TraceSpace<dim>::Basis::value(component[k], cell.surface_points[q]) * cell.normals[q][c];
    }
  }
}

template <int dim>
void MembraneBending<dim>::compute_moment(const TraceField<dim> *const concentration,
                                          const TraceField<dim> *const total_concentration)
{
  using Basis = typename TraceSpace<dim>::Basis;
  moments = energies = curvature_at_points;
  auto right_side = system.make_vector();
  std::array<double, Basis::n> local;
  SurfacePoint<dim> point;
  double energy = 0., largest_numerical_rigidity = 0.;
  for (unsigned int b = 0; b < space.active_mesh().size(); ++b)
  {
    const CutCell<dim> &cell = *space.active_mesh()[b].cut;
    const unsigned int k = space.active_mesh()[b].cut_index;
    local.fill(0.);
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      point.reinit(cell, q);
      const double composition =
          concentration != nullptr ? point.value((*concentration)[k]) / point.value((*total_concentration)[k])
                                   : 0.;
      const auto bending = law.evaluate(curvature_at_points[k][q], composition);
      moments[k][q] = bending.moment;
      energies[k][q] = bending.energy;
      largest_numerical_rigidity = std::max(largest_numerical_rigidity, bending.numerical_rigidity);
      energy += cell.surface_weights[q] * (bending.energy - bending.numerical_energy);
      for (unsigned int i = 0; i < Basis::n; ++i)
        local[i] += cell.surface_weights[q] * bending.moment * point.values[i];
    }
    system.add_right_side(b, local.data(), right_side);
  }
  moment_field = space.extract(system, system.solve(std::move(right_side)));
  total_energy = Utilities::MPI::sum(energy, space.communicator());
  numerical_rigidity = Utilities::MPI::max(largest_numerical_rigidity, space.communicator());
}

template <int dim>
MembranePointValues MembraneBending<dim>::tension() const
{
  PointValues result = energies;
  for (unsigned int k = 0; k < result.size(); ++k)
    for (unsigned int q = 0; q < result[k].size(); ++q)
      result[k][q] -= moments[k][q] * curvature_at_points[k][q];
  return result;
}

template class MembraneBending<2>;
template class MembraneBending<3>;
} // namespace Gemmule
