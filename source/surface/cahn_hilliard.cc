// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/geometry/membrane_snapshot.h>
#include <gemmule/model/membrane_model.h>
#include <gemmule/parameters/discretisation.h>
#include <gemmule/surface/cahn_hilliard.h>
#include <gemmule/surface/trace_forms.h>

#include <deal.II/base/mpi.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  template <int dim, int degree>
  std::vector<std::vector<double>>
  at_points(const CutGeometry<dim> &geometry,
            const std::vector<std::array<double, TensorLagrange<dim, degree>::n>> &field)
  {
    std::vector<std::vector<double>> values(field.size());
    for (unsigned int k = 0; k < field.size(); ++k)
      for (const auto &p : geometry.cut_cells()[k].surface_points)
        values[k].push_back(TensorLagrange<dim, degree>::value(field[k], p));
    return values;
  }
} // namespace

template <int dim>
CahnHilliard<dim>::CahnHilliard(const MembraneModel &model, const Parameters::Surface &parameters,
                                const MPI_Comm communicator)
    : model(model), parameters(parameters), communicator(communicator), system(communicator, false)
{
}

template <int dim>
MembraneModel::ChemicalPotential
CahnHilliard<dim>::local_potential(const unsigned int cell, const unsigned int q, const double value) const
{
  const double total = total_at_points[cell][q];
  return curvature_at_points != nullptr
             ? model.local_chemical_potential(value, total, (*curvature_at_points)[cell][q])
             : model.local_chemical_potential(value, total);
}

template <int dim>
void CahnHilliard<dim>::linearise()
{
  slope = intercept = f_at_points;
  for (unsigned int k = 0; k < f_at_points.size(); ++k)
    for (unsigned int q = 0; q < f_at_points[k].size(); ++q)
    {
      const auto local = local_potential(k, q, f_at_points[k][q]);
      slope[k][q] = local.by_f;
      intercept[k][q] = local.value - local.by_f * f_at_points[k][q];
    }
}

template <int dim>
std::pair<double, double> CahnHilliard<dim>::update_points(const TraceSpace<dim> &space,
                                                           const TraceField<dim> &field)
{
  f_at_points = at_points<dim, 2>(space.geometry(), field);
  double error = 0., magnitude = 0.;
  for (unsigned int k = 0; k < f_at_points.size(); ++k)
    for (unsigned int q = 0; q < f_at_points[k].size(); ++q)
    {
      const double value = local_potential(k, q, f_at_points[k][q]).value;
      const double new_intercept = value - slope[k][q] * f_at_points[k][q];
      const double difference = std::abs(new_intercept - intercept[k][q]);
      // a maximum would swallow NaN
      error = difference <= error ? error : (std::isfinite(difference) ? difference : 1e300);
      magnitude = std::max(magnitude, std::abs(value));
      intercept[k][q] = new_intercept;
    }
  return {Utilities::MPI::max(error, communicator), Utilities::MPI::max(magnitude, communicator)};
}

template <int dim>
void CahnHilliard<dim>::assemble_matrix(const TraceSpace<dim> &space, const SurfaceStep<dim> &step)
{
  constexpr unsigned int n = TraceSpace<dim>::Basis::n;
  const double rate = step.bdf.a0 / step.time_step;
  const double mobility = 1. / model.peclet_number();
  const double square = model.cahn_number() * model.cahn_number();
  system.zero_matrix();
  FullMatrix<double> matrix(2 * n, 2 * n);
  SurfacePoint<dim> point;
  for (unsigned int k = 0; k < space.active_mesh().size(); ++k)
  {
    const auto &cell = space.active_mesh()[k];
    const double penalty = parameters.normal_stabilisation / cell.size;
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
      {
        const double s = penalty * cell.normal_derivatives(i, j);
        matrix(i, j) = s;
        matrix(i, n + j) = mobility * s;
        matrix(n + i, j) = -square * s;
        matrix(n + i, n + j) = 0.;
      }
    if (cell.cut)
      for (unsigned int q = 0; q < cell.cut->surface_points.size(); ++q)
      {
        point.reinit(*cell.cut, q);
        const double weight = cell.cut->surface_weights[q];
        const auto velocity =
            TensorLagrange<dim, 3>::value((*step.velocity)[cell.cut_index], cell.cut->surface_points[q]);
        const double local_slope = slope[cell.cut_index][q];
        for (unsigned int i = 0; i < n; ++i)
        {
          const double transport = weight * (rate * point.values[i] - velocity * point.gradients[i]);
          for (unsigned int j = 0; j < n; ++j)
          {
            const double mass = weight * point.values[i] * point.values[j];
            const double stiffness = weight * (point.surface_gradients[i] * point.surface_gradients[j]);
            matrix(i, j) += transport * point.values[j];
            matrix(i, n + j) += mobility * stiffness;
            matrix(n + i, j) -= local_slope * mass + square * stiffness;
            matrix(n + i, n + j) += mass;
          }
        }
      }
    system.add_matrix(k, matrix);
  }
  system.factorise();
}

template <int dim>
LinearSystem::Vector CahnHilliard<dim>::assemble_rhs(const TraceSpace<dim> &space,
                                                     const SurfaceStep<dim> &step) const
{
  using Basis = typename TraceSpace<dim>::Basis;
  auto rhs = system.make_vector();
  std::array<double, 2 * Basis::n> local;
  typename Basis::Values values;
  for (unsigned int k = 0; k < space.active_mesh().size(); ++k)
  {
    const auto &cell = space.active_mesh()[k];
    local.fill(0.);
    add_history(cell, step, &MembraneCloud<dim>::concentration, local.data());
    if (cell.cut)
      for (unsigned int q = 0; q < cell.cut->surface_points.size(); ++q)
      {
        Basis::evaluate(cell.cut->surface_points[q], values);
        const double factor = cell.cut->surface_weights[q] * intercept[cell.cut_index][q];
        for (unsigned int i = 0; i < Basis::n; ++i)
          local[Basis::n + i] += factor * values[i];
      }
    system.add_right_side(k, local.data(), rhs);
  }
  return rhs;
}

template <int dim>
void CahnHilliard<dim>::advance(const TraceSpace<dim> &space, const SurfaceStep<dim> &step,
                                const TraceField<dim> &total_concentration)
{
  total_at_points = at_points<dim, 2>(space.geometry(), total_concentration);
  f_at_points = at_points<dim, 3>(space.geometry(), *step.predicted_concentration);
  curvature_at_points = step.curvature;
  begin_system(space, 2, system);

  // A good predictor makes the matrix of the first iteration good for all: it is renewed only when the error
  // falls slowly.
  bool matrix_is_good = false;
  double last_error = 0.;
  for (n_iterations = 1; n_iterations <= parameters.newton_maximum_iterations; ++n_iterations)
  {
    if (!matrix_is_good)
    {
      linearise();
      assemble_matrix(space, step);
    }
    const auto solution = system.solve(assemble_rhs(space, step));
    f = space.extract(system, solution, 0);
    mu = space.extract(system, solution, 1);
    const auto [error, magnitude] = update_points(space, f);
    if (error <= parameters.newton_tolerance * std::max(magnitude, 1e-3))
      return;
    if (!(error < 1e100))
      break;
    matrix_is_good = error < 0.1 * (n_iterations == 1 ? 0.01 * magnitude : last_error);
    last_error = error;
  }
  throw StepBreakdown("Newton's method for the Cahn-Hilliard equation did not converge in " +
                      std::to_string(std::min(n_iterations, parameters.newton_maximum_iterations)) +
                      " iterations.");
}

template <int dim>
void CahnHilliard<dim>::initialise(const TraceSpace<dim> &space, const TraceField<dim> &concentration,
                                   const TraceField<dim> &total_concentration,
                                   const MembranePointValues *const curvature)
{
  constexpr unsigned int n = TraceSpace<dim>::Basis::n;
  f = concentration;
  total_at_points = at_points<dim, 2>(space.geometry(), total_concentration);
  curvature_at_points = curvature;
  LinearSystem projection(communicator, true);
  begin_system(space, 1, projection);
  projection.zero_matrix();
  auto rhs = projection.make_vector();
  const double square = model.cahn_number() * model.cahn_number();
  FullMatrix<double> matrix(n, n);
  std::array<double, n> local;
  SurfacePoint<dim> point;
  for (unsigned int k = 0; k < space.active_mesh().size(); ++k)
  {
    const auto &cell = space.active_mesh()[k];
    stabilised_mass_matrix(cell, matrix);
    local.fill(0.);
    if (cell.cut)
    {
      const auto &nodal_f = f[cell.cut_index];
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          local[i] += square * parameters.normal_stabilisation / cell.size * cell.normal_derivatives(i, j) *
                      nodal_f[j];
      for (unsigned int q = 0; q < cell.cut->surface_points.size(); ++q)
      {
        point.reinit(*cell.cut, q);
        const double weight = cell.cut->surface_weights[q];
        const double value = local_potential(cell.cut_index, q, point.value(nodal_f)).value;
        const auto gradient = square * point.surface_gradient(nodal_f);
        for (unsigned int i = 0; i < n; ++i)
          local[i] += weight * (value * point.values[i] + gradient * point.surface_gradients[i]);
      }
    }
    projection.add_matrix(k, matrix);
    projection.add_right_side(k, local.data(), rhs);
  }
  projection.factorise();
  mu = space.extract(projection, projection.solve(std::move(rhs)));
  n_iterations = 0;
}

template class CahnHilliard<2>;
template class CahnHilliard<3>;
} // namespace Gemmule
