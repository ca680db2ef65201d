// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/geometry/membrane_snapshot.h>
#include <gemmule/surface/smoothed_update.h>
#include <gemmule/surface/trace_forms.h>

#include <deal.II/base/mpi.h>

#include <numeric>

namespace Gemmule
{
using namespace dealii;

template <int dim>
SmoothedUpdate<dim>::SmoothedUpdate(const double smoothing, const double stabilisation,
                                    const MPI_Comm communicator)
    : smoothing(smoothing), stabilisation(stabilisation), system(communicator, false)
{
}

template <int dim>
std::vector<std::vector<double>> SmoothedUpdate<dim>::source(const TraceSpace<dim> &space,
                                                             const SurfaceStep<dim> &step) const
{
  using Cubic = TensorLagrange<dim, 3>;
  typename Cubic::Values values;
  typename Cubic::Gradients gradients;
  std::vector<std::vector<double>> result;
  for (unsigned int k = 0; k < space.geometry().cut_cells().size(); ++k)
  {
    const auto &cell = space.geometry().cut_cells()[k];
    const auto &nodal_velocity = (*step.velocity)[k];
    const auto &nodal_total = (*step.predicted_total_concentration)[k];
    std::vector<double> of_cell;
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      Cubic::evaluate(cell.surface_points[q], values, gradients);
      const auto &normal = cell.normals[q];
      double total = 0., divergence = 0.;
      Tensor<1, dim> velocity, gradient;
      for (unsigned int i = 0; i < Cubic::n; ++i)
      {
        const auto surface_gradient = (gradients[i] - (normal * gradients[i]) * normal) / cell.size;
        total += values[i] * nodal_total[i];
        gradient += nodal_total[i] * surface_gradient;
        velocity += values[i] * nodal_velocity[i];
        divergence += surface_gradient * nodal_velocity[i];
      }
      of_cell.push_back(velocity * gradient + total * divergence);
    }
    result.push_back(std::move(of_cell));
  }
  return result;
}

template <int dim>
TraceField<dim> SmoothedUpdate<dim>::smoothed_rate(const TraceSpace<dim> &space,
                                                   const std::vector<std::vector<double>> &source)
{
  constexpr unsigned int n = TraceSpace<dim>::Basis::n;
  begin_system(space, 2, system);
  system.zero_matrix();
  auto rhs = system.make_vector();
  FullMatrix<double> matrix(2 * n, 2 * n), stiffness(n, n), mass(n, n);
  std::array<double, 2 * n> local;
  SurfacePoint<dim> point;
  for (unsigned int k = 0; k < space.active_mesh().size(); ++k)
  {
    const auto &cell = space.active_mesh()[k];
    stiffness.equ(stabilisation / cell.size, cell.normal_derivatives);
    mass.equ(stabilisation * cell.size, cell.normal_derivatives);
    local.fill(0.);
    if (cell.cut)
      for (unsigned int q = 0; q < cell.cut->surface_points.size(); ++q)
      {
        point.reinit(*cell.cut, q);
        const double weight = cell.cut->surface_weights[q];
        for (unsigned int i = 0; i < n; ++i)
        {
          local[i] -= weight * source[cell.cut_index][q] * point.values[i];
          for (unsigned int j = 0; j < n; ++j)
          {
            mass(i, j) += weight * point.values[i] * point.values[j];
            stiffness(i, j) += weight * (point.surface_gradients[i] * point.surface_gradients[j]);
          }
        }
      }
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
      {
        matrix(i, j) = matrix(n + i, n + j) = mass(i, j);
        matrix(i, n + j) = smoothing * stiffness(i, j);
        matrix(n + i, j) = -stiffness(i, j);
      }
    system.add_matrix(k, matrix);
    system.add_right_side(k, local.data(), rhs);
  }
  system.factorise();
  return space.extract(system, system.solve(std::move(rhs)));
}

template <int dim>
TraceField<dim> SmoothedUpdate<dim>::integrate(const TraceSpace<dim> &space, const SurfaceStep<dim> &step,
                                               const TraceField<dim> &rate) const
{
  using Quadratic = TensorLagrange<dim, 2>;
  using Cubic = TensorLagrange<dim, 3>;
  return project<dim>(space,
                      [&](const unsigned int k, const unsigned int q, const Point<dim> &)
                      {
                        const auto &p = space.geometry().cut_cells()[k].surface_points[q];
                        double sum = step.time_step * Quadratic::value(rate[k], p);
                        for (unsigned int level = 0; level < 2; ++level)
                          if (const auto *old = step.extended_total_concentration[level])
                            sum -= (level == 0 ? step.bdf.a1 : step.bdf.a2) * Cubic::value((*old)[k], p);
                        return sum / step.bdf.a0;
                      });
}

template <int dim>
void SmoothedUpdate<dim>::restore_mass(const TraceSpace<dim> &space, const MembraneCloud<dim> &previous,
                                       TraceField<dim> &field)
{
  double mass = 0., smallest = std::numeric_limits<double>::max();
  for (unsigned int k = 0; k < field.size(); ++k)
  {
    const auto &cell = space.geometry().cut_cells()[k];
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      const double value = TensorLagrange<dim, 2>::value(field[k], cell.surface_points[q]);
      mass += cell.surface_weights[q] * value;
      smallest = std::min(smallest, value);
    }
  }
  mass = Utilities::MPI::sum(mass, space.communicator());
  smallest = Utilities::MPI::min(smallest, space.communicator());
  const double target = std::inner_product(previous.weights.begin(), previous.weights.end(),
                                           previous.total_concentration.begin(), 0.);
  shift = (target - mass) / space.geometry().measure();
  if (smallest + shift <= 0.)
    throw SimulationError(
        "The total concentration has reached zero, where the model with update smoothing ends; "
        "raise the smoothing coefficient or choose another regularisation.");
  for (auto &nodal : field)
    for (auto &value : nodal)
      value += shift;
}

template <int dim>
TraceField<dim> SmoothedUpdate<dim>::advance(const TraceSpace<dim> &space, const SurfaceStep<dim> &step)
{
  AssertThrow(step.clouds[0] && step.velocity && step.predicted_total_concentration &&
                  step.extended_total_concentration[0] &&
                  (step.bdf.order() == 1 || step.extended_total_concentration[1]),
              ExcMessage("Update smoothing needs predicted and extended total concentrations."));
  const auto rate = smoothed_rate(space, source(space, step));
  auto field = integrate(space, step, rate);
  restore_mass(space, *step.clouds[0], field);
  return field;
}

template class SmoothedUpdate<2>;
template class SmoothedUpdate<3>;
} // namespace Gemmule
