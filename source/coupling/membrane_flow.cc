// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/raise_together.h>
#include <gemmule/coupling/membrane_flow.h>
#include <gemmule/flow/bending_force.h>
#include <gemmule/flow/semi_implicit_bending.h>
#include <gemmule/flow/semi_implicit_tension.h>
#include <gemmule/flow/tension_force.h>
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
  MembranePointValues prescribed;
  std::string complaint;
  for (const auto &cell : membrane.geometry.cut_cells())
  {
    prescribed.emplace_back();
    for (const auto &unit_point : cell.surface_points)
    {
      const Point<dim> point = cell.physical(unit_point);
      prescribed.back().push_back(prescribed_tension->value(point));
      if (!std::isfinite(prescribed.back().back()) && complaint.empty())
        complaint = not_finite_complaint<dim>(*prescribed_tension, {point});
    }
  }
  raise_together("Membrane/Prescribed tension", complaint, communicator);
  return prescribed;
}

template <int dim>
MembranePointValues MembraneFlow<dim>::stiff_tension(const MembraneBending<dim> *const bending) const
{
  MembranePointValues stiff = sigma;
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
void MembraneFlow<dim>::add_semi_implicit_terms(const Membrane &membrane, const double dt,
                                                const CutCellVector<dim> &old_velocity, Terms &terms) const
{
  const double coefficient = parameters.time_stepping.tension_implicitness * dt;
  if (coefficient == 0.)
    return;
  const double capillary_number = parameters.fluid.capillary_number;
  terms.push_back(std::make_shared<SemiImplicitTension<dim>>(
      typename SemiImplicitTension<dim>::Parameters{coefficient, stiff_tension(membrane.bending),
                                                    dilatational_modulus(membrane), old_velocity},
      capillary_number));
  if (membrane.bending != nullptr)
    terms.push_back(std::make_shared<SemiImplicitBending<dim>>(
        bending_stiffness_margin * coefficient * membrane.bending->get_law().largest_rigidity(),
        membrane.bending->shared_trace_space(), old_velocity, capillary_number));
}

template <int dim>
std::shared_ptr<ArclengthConstraint<dim>> MembraneFlow<dim>::make_constraint(const Membrane &membrane,
                                                                             const double dt) const
{
  const double capillary_number = parameters.fluid.capillary_number;
  const auto &arclength = parameters.arclength;
  if (arclength.model == Parameters::ArclengthModel::multiplier)
    // It holds dL/dt = 0; what a step changes nevertheless, the motion of the next one corrects.
    return std::make_shared<ArclengthConstraint<dim>>(
        typename ArclengthConstraint<dim>::Penalty{std::numeric_limits<double>::infinity(), 0., 1.},
        capillary_number);
  if (arclength.model == Parameters::ArclengthModel::penalty && arclength.penalty > 0.)
    return std::make_shared<ArclengthConstraint<dim>>(
        typename ArclengthConstraint<dim>::Penalty{
            arclength.penalty, membrane.geometry.measure() - membrane.reference_arclength, dt},
        capillary_number);
  return nullptr;
}

template <int dim>
void MembraneFlow<dim>::solve(const double time, const double dt, const Membrane &membrane,
                              const CutCellVector<dim> *const old_velocity, TimerOutput &timer)
{
  constraint.reset(); // should this fail: that of an earlier flow has no meaning
  sigma = tension_of(membrane, time);
  boundary_velocity->set_time(time);
  Terms terms{std::make_shared<TensionForce<dim>>(sigma, parameters.fluid.capillary_number)};
  if (membrane.bending != nullptr)
    terms.push_back(
        std::make_shared<BendingForce<dim>>(*membrane.bending, parameters.fluid.capillary_number));
  if (old_velocity != nullptr)
    add_semi_implicit_terms(membrane, dt, *old_velocity, terms);
  const auto new_constraint = make_constraint(membrane, dt);
  if (new_constraint != nullptr)
    terms.push_back(new_constraint);
  {
    TimerOutput::Scope scope(timer, "flow: assembly and factorisation");
    stokes.prepare(membrane.geometry, *boundary_velocity, terms);
  }
  TimerOutput::Scope scope(timer, "flow: solution");
  stokes.solve();
  constraint = new_constraint;
}

template <int dim>
MembranePointValues MembraneFlow<dim>::tension() const
{
  MembranePointValues total = sigma;
  for (auto &cell : total)
    for (double &value : cell)
      value += constraint_tension();
  return total;
}

template <int dim>
double MembraneFlow<dim>::tension_energy(const CutGeometry<dim> &geometry) const
{
  double energy = 0.;
  for (unsigned int c = 0; c < sigma.size(); ++c)
    for (unsigned int q = 0; q < sigma[c].size(); ++q)
      energy += geometry.cut_cells()[c].surface_weights[q] * sigma[c][q];
  return Utilities::MPI::sum(energy, communicator);
}

template <int dim>
double MembraneFlow<dim>::smallest_tension() const
{
  double smallest = std::numeric_limits<double>::max();
  for (const auto &cell : sigma)
    for (const double value : cell)
      smallest = std::min(smallest, value + constraint_tension());
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
    for (const double value : sigma[c])
      capillary = std::min(capillary, cell.size / std::max(std::abs(value + constraint_tension()), tiny));
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
