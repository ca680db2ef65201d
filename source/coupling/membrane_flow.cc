// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/raise_together.h>
#include <gemmule/coupling/membrane_flow.h>
#include <gemmule/flow/bending_force.h>
#include <gemmule/flow/semi_implicit_bending.h>
#include <gemmule/parameters/expression.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // S = 0.4 of the bare stiffness is enough for constant steps in the linear model. Steps that alternate by a
  // factor of two need about 1.8, and the level set feels the shortest waves more than their trace tells.
  constexpr double bending_stiffness_margin = 5.;
} // namespace

template <int dim>
MembraneFlow<dim>::MembraneFlow(const Triangulation &triangulation, const AllParameters &parameters,
                                const MembraneModel &model)
    : parameters(parameters), model(model), communicator(triangulation.get_communicator()),
      boundary_velocity(
          make_function<dim>(parameters.domain.boundary_velocity, dim, "Domain/Boundary velocity")),
      prescribed_tension(
          make_function<dim>(parameters.membrane.prescribed_tension, 1, "Membrane/Prescribed tension")),
      stokes(triangulation, parameters.fluid, parameters.flow)
{
}

template <int dim>
MembranePointValues MembraneFlow<dim>::tension_of(const Membrane &membrane, const double time) const
{
  if (membrane.surface != nullptr)
    return membrane.surface->tension(membrane.bending != nullptr ? &membrane.bending->curvature() : nullptr);

  prescribed_tension->set_time(time);
  MembranePointValues sigma;
  std::string complaint;
  for (const auto &cell : membrane.geometry.cut_cells())
  {
    sigma.emplace_back();
    for (const auto &unit_point : cell.surface_points)
    {
      const Point<dim> point = cell.physical(unit_point);
      sigma.back().push_back(prescribed_tension->value(point));
      if (!std::isfinite(sigma.back().back()) && complaint.empty())
        complaint = not_finite_complaint<dim>(*prescribed_tension, {point});
    }
  }
  raise_together("Membrane/Prescribed tension", complaint, communicator);
  return sigma;
}

template <int dim>
MembranePointValues MembraneFlow<dim>::stiff_tension(const MembraneBending<dim> *const bending) const
{
  MembranePointValues stiff = total_tension;
  if (bending == nullptr)
    return stiff;
  const MembranePointValues tension_of_bending = bending->tension();
  for (unsigned int c = 0; c < stiff.size(); ++c)
    for (unsigned int q = 0; q < stiff[c].size(); ++q)
      stiff[c][q] += std::max(tension_of_bending[c][q], 0.);
  return stiff;
}

template <int dim>
MembranePointValues MembraneFlow<dim>::dilatational_modulus(const Membrane &membrane) const
{
  const auto &cut_cells = membrane.geometry.cut_cells();
  MembranePointValues modulus(membrane.surface != nullptr ? cut_cells.size() : 0);
  for (unsigned int c = 0; c < modulus.size(); ++c)
    for (const auto &point : cut_cells[c].surface_points)
      modulus[c].push_back(model.dilatational_modulus(
          TensorLagrange<dim, 2>::value(membrane.surface->total_concentration()[c], point)));
  return modulus;
}

template <int dim>
void MembraneFlow<dim>::solve(const double time, const double dt, const Membrane &membrane,
                              const CutCellVector<dim> *const old_velocity, TimerOutput &timer)
{
  total_tension = tension_of(membrane, time);
  boundary_velocity->set_time(time);
  std::unique_ptr<BendingForce<dim>> bending_force;
  if (membrane.bending != nullptr)
  {
    const auto *const surface = membrane.surface;
    membrane.bending->compute_moment(surface != nullptr ? &surface->concentration() : nullptr,
                                     surface != nullptr ? &surface->total_concentration() : nullptr);
    bending_force = std::make_unique<BendingForce<dim>>(*membrane.bending, membrane.geometry);
  }

  const MembranePointValues stiff = stiff_tension(membrane.bending), modulus = dilatational_modulus(membrane);
  const SemiImplicitTension<dim> semi_implicit{parameters.time_stepping.tension_implicitness * dt, &stiff,
                                               membrane.surface != nullptr ? &modulus : nullptr,
                                               old_velocity};
  SemiImplicitBending<dim> semi_implicit_bending;
  if (membrane.bending != nullptr)
  {
    semi_implicit_bending.coefficient =
        bending_stiffness_margin * semi_implicit.coefficient * model.bending().largest_rigidity();
    semi_implicit_bending.space = &membrane.bending->trace_space();
    semi_implicit_bending.old_velocity = old_velocity;
  }
  const bool is_semi_implicit = old_velocity != nullptr && semi_implicit.coefficient > 0.;
  {
    TimerOutput::Scope scope(timer, "flow: assembly and factorisation");
    stokes.prepare(membrane.geometry, *boundary_velocity, is_semi_implicit ? &semi_implicit : nullptr,
                   is_semi_implicit && membrane.bending != nullptr ? &semi_implicit_bending : nullptr);
  }
  TimerOutput::Scope scope(timer, "flow: solution");
  solve_with_constraint(membrane, dt, bending_force.get());
}

template <int dim>
void MembraneFlow<dim>::solve_with_constraint(const Membrane &membrane, const double dt,
                                              const BendingForce<dim> *const bending_force)
{
  if (parameters.arclength.model == Parameters::ArclengthModel::none)
  {
    stokes.solve(total_tension, nullptr, bending_force);
    return;
  }
  // The multiplier holds dL/dt = 0; what a step changes nevertheless, the motion of the next one corrects.
  const ArclengthPenalty penalty =
      parameters.arclength.model == Parameters::ArclengthModel::multiplier
          ? ArclengthPenalty{std::numeric_limits<double>::infinity(), 0., 1.}
          : ArclengthPenalty{parameters.arclength.penalty,
                             membrane.geometry.measure() - membrane.reference_arclength, dt};
  stokes.solve(total_tension, &penalty, bending_force);
  for (auto &cell : total_tension)
    for (double &sigma : cell)
      sigma += stokes.constraint_tension();
}

template <int dim>
double MembraneFlow<dim>::smallest_tension() const
{
  double smallest = std::numeric_limits<double>::max();
  for (const auto &cell : total_tension)
    for (const double sigma : cell)
      smallest = std::min(smallest, sigma);
  return Utilities::MPI::min(smallest, communicator);
}

template <int dim>
TimeStepLimits MembraneFlow<dim>::time_step_limits(const CutGeometry<dim> &geometry) const
{
  constexpr double tiny = 1e-12;
  double capillary = std::numeric_limits<double>::max(), displacement = capillary;
  for (unsigned int c = 0; c < geometry.cut_cells().size(); ++c)
  {
    const CutCell<dim> &cell = geometry.cut_cells()[c];
    for (const double sigma : total_tension[c])
      capillary = std::min(capillary, cell.size / std::max(std::abs(sigma), tiny));
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      const double speed = stokes.membrane_velocity()[c].value(cell.surface_points[q]) * cell.normals[q];
      displacement = std::min(displacement, cell.size / std::max(std::abs(speed), tiny));
    }
  }
  return {parameters.fluid.capillary_number * Utilities::MPI::min(capillary, communicator),
          Utilities::MPI::min(displacement, communicator)};
}

template class MembraneFlow<2>;
template class MembraneFlow<3>;
} // namespace Gemmule
