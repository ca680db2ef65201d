// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/surface/trace_space.h>

#include <functional>

namespace Gemmule
{
class LinearSystem;
template <int dim>
struct MembraneCloud;

/** The shape functions of the trace space at one quadrature point of the membrane. */
template <int dim>
class SurfacePoint
{
public:
  using Basis = TensorLagrange<dim, 2>;

  void reinit(const CutCell<dim> &cell, unsigned int q)
  {
    Basis::evaluate(cell.surface_points[q], values, gradients);
    const auto &normal = cell.normals[q];
    const double inverse_size = 1. / cell.size;
    for (unsigned int i = 0; i < Basis::n; ++i)
    {
      gradients[i] *= inverse_size;
      surface_gradients[i] = gradients[i] - (normal * gradients[i]) * normal;
    }
  }

  double value(const std::array<double, Basis::n> &nodal) const
  {
    double sum = 0.;
    for (unsigned int i = 0; i < Basis::n; ++i)
      sum += values[i] * nodal[i];
    return sum;
  }

  dealii::Tensor<1, dim> surface_gradient(const std::array<double, Basis::n> &nodal) const
  {
    dealii::Tensor<1, dim> sum;
    for (unsigned int i = 0; i < Basis::n; ++i)
      sum += nodal[i] * surface_gradients[i];
    return sum;
  }

  typename Basis::Values values;
  typename Basis::Gradients gradients;         ///< full gradients, in physical coordinates
  typename Basis::Gradients surface_gradients; ///< (I - n n^T) grad
};

/** Sizes @p system for @p n_fields trace fields, stacked one after the other, with one element per cell of
 * the active mesh. */
template <int dim>
void begin_system(const TraceSpace<dim> &space, unsigned int n_fields, LinearSystem &system);

/** matrix = int_membrane y v + h int_active (n.grad y)(n.grad v), the part of one cell of the active mesh. */
template <int dim>
void stabilised_mass_matrix(const TraceCell<dim> &cell, dealii::FullMatrix<double> &matrix);

/**
 * local[i] -= (a1 sum_{cloud n-1} w y phi_i + a2 sum_{cloud n-2} w y phi_i) / dt: what the earlier membranes
 * contribute to the right side of the conservative scheme in one cell of the active mesh.
 *
 * @param density the member of MembraneCloud that is transported (f or fbar)
 */
template <int dim>
void add_history(const TraceCell<dim> &cell, const SurfaceStep<dim> &step,
                 std::vector<double> MembraneCloud<dim>::*density, double *local);

/**
 * L2-projection on the trace space of @p function, which gets cut cell (its number), quadrature point (its
 * number) and its position; normally extended by the stabilisation h int_active (n.grad y)(n.grad v).
 * Collective.
 */
template <int dim>
TraceField<dim>
project(const TraceSpace<dim> &space,
        const std::function<double(unsigned int, unsigned int, const dealii::Point<dim> &)> &function);
} // namespace Gemmule
