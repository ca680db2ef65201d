// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/geometry/membrane_snapshot.h>
#include <gemmule/surface/conservative_transport.h>
#include <gemmule/surface/trace_forms.h>

namespace Gemmule
{
using namespace dealii;

template <int dim>
ConservativeTransport<dim>::ConservativeTransport(const double diffusion, const double stabilisation,
                                                  const MPI_Comm communicator)
    : diffusion(diffusion), stabilisation(stabilisation), system(communicator, false)
{
}

template <int dim>
TraceField<dim> ConservativeTransport<dim>::advance(const TraceSpace<dim> &space,
                                                    const SurfaceStep<dim> &step)
{
  constexpr unsigned int n = TraceSpace<dim>::Basis::n;
  begin_system(space, 1, system);
  system.zero_matrix();
  auto rhs = system.make_vector();

  const double rate = step.bdf.a0 / step.time_step;
  FullMatrix<double> matrix(n, n);
  std::array<double, n> local;
  SurfacePoint<dim> point;
  for (unsigned int k = 0; k < space.active_mesh().size(); ++k)
  {
    const auto &cell = space.active_mesh()[k];
    matrix.equ(stabilisation / cell.size, cell.normal_derivatives);
    if (cell.cut)
      for (unsigned int q = 0; q < cell.cut->surface_points.size(); ++q)
      {
        point.reinit(*cell.cut, q);
        const double weight = cell.cut->surface_weights[q];
        const auto velocity =
            TensorLagrange<dim, 3>::value((*step.velocity)[cell.cut_index], cell.cut->surface_points[q]);
        for (unsigned int i = 0; i < n; ++i)
        {
          const double value_factor = weight * (rate * point.values[i] - velocity * point.gradients[i]);
          const auto gradient_factor = weight * diffusion * point.surface_gradients[i];
          for (unsigned int j = 0; j < n; ++j)
            matrix(i, j) += value_factor * point.values[j] + gradient_factor * point.surface_gradients[j];
        }
      }
    local.fill(0.);
    add_history(cell, step, &MembraneCloud<dim>::total_concentration, local.data());
    system.add_matrix(k, matrix);
    system.add_right_side(k, local.data(), rhs);
  }
  system.factorise();
  return space.extract(system, system.solve(std::move(rhs)));
}

template class ConservativeTransport<2>;
template class ConservativeTransport<3>;
} // namespace Gemmule
