// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/bulk_integrals.h>
#include <gemmule/flow/interior_face.h>
#include <gemmule/flow/stokes_reference_matrices.h>
#include <gemmule/parameters/discretisation.h>

#include <deal.II/base/quadrature_lib.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  /** First and second normal derivative jumps of all shapes of the two cells at one point of their face. */
  template <typename Basis, int dim>
  void normal_derivative_jumps(const Point<dim> &in_first, const Point<dim> &in_second,
                               const unsigned int direction, const double size_ratio,
                               std::array<double, 2 * Basis::n> &first,
                               std::array<double, 2 * Basis::n> &second)
  {
    typename Basis::Values values;
    typename Basis::Gradients gradients;
    typename Basis::Hessians hessians;
    Basis::evaluate(in_first, values, gradients, hessians);
    for (unsigned int i = 0; i < Basis::n; ++i)
    {
      first[i] = gradients[i][direction];
      second[i] = hessians[i][direction][direction];
    }
    Basis::evaluate(in_second, values, gradients, hessians);
    for (unsigned int i = 0; i < Basis::n; ++i)
    {
      first[Basis::n + i] = -gradients[i][direction] / size_ratio;
      second[Basis::n + i] = -hessians[i][direction][direction] / (size_ratio * size_ratio);
    }
  }

  template <std::size_t n>
  void add_product(const std::array<double, n> &v, const double weight, FullMatrix<double> &matrix)
  {
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        matrix(i, j) += weight * v[i] * v[j];
  }
} // namespace

template <int dim>
StokesReferenceMatrices<dim>::StokesReferenceMatrices(const Parameters::Flow &parameters)
{
  integrate_cell();
  for (unsigned int face = 0; face < 2 * dim; ++face)
    for (unsigned int refinement = 0; refinement <= n_child_faces; ++refinement)
      faces[face][refinement] = integrate_face(face, refinement, parameters);
}

template <int dim>
void StokesReferenceMatrices<dim>::integrate_cell()
{
  const QGauss<dim> quadrature(3);
  BulkIntegrals<dim> bulk;
  bulk.clear();
  for (unsigned int q = 0; q < quadrature.size(); ++q)
    bulk.add(quadrature.point(q), quadrature.weight(q));
  viscous.reinit(Layout::n, Layout::n);
  divergence.reinit(Layout::n, Layout::n);
  bulk.add_to(viscous, 0, 1., 0.);
  bulk.add_to(divergence, 0, 0., 1.);
}

template <int dim>
FullMatrix<double> StokesReferenceMatrices<dim>::cell(const double viscosity, const double h) const
{
  FullMatrix<double> matrix(Layout::n, Layout::n);
  matrix.equ(viscosity * std::pow(h, dim - 2), viscous);
  matrix.add(std::pow(h, dim - 1), divergence);
  return matrix;
}

template <int dim>
GhostPenaltyMatrices StokesReferenceMatrices<dim>::integrate_face(const unsigned int face_number,
                                                                  const unsigned int refinement,
                                                                  const Parameters::Flow &parameters) const
{
  const unsigned int direction = face_number / 2;
  const double size_ratio = refinement == 0 ? 1. : 2.;

  GhostPenaltyMatrices matrices;
  matrices.velocity.reinit(2 * Layout::n_velocity_nodes, 2 * Layout::n_velocity_nodes);
  matrices.pressure.reinit(2 * Layout::n_pressure_nodes, 2 * Layout::n_pressure_nodes);

  const QGauss<dim - 1> quadrature(3); // exact for Q2 times Q2
  for (unsigned int q = 0; q < quadrature.size(); ++q)
  {
    const auto [in_first, in_second] = on_both_sides<dim>(face_number, refinement, quadrature.point(q));
    std::array<double, 2 * Layout::n_velocity_nodes> velocity_1, velocity_2;
    normal_derivative_jumps<typename Layout::VelocityBasis>(in_first, in_second, direction, size_ratio,
                                                            velocity_1, velocity_2);
    add_product(velocity_1, parameters.velocity_gradient_ghost_penalty * quadrature.weight(q),
                matrices.velocity);
    add_product(velocity_2, parameters.velocity_curvature_ghost_penalty * quadrature.weight(q),
                matrices.velocity);

    std::array<double, 2 * Layout::n_pressure_nodes> pressure_1, pressure_2;
    normal_derivative_jumps<typename Layout::PressureBasis>(in_first, in_second, direction, size_ratio,
                                                            pressure_1, pressure_2);
    add_product(pressure_1, parameters.pressure_ghost_penalty * quadrature.weight(q), matrices.pressure);
  }
  return matrices;
}

template class StokesReferenceMatrices<2>;
template class StokesReferenceMatrices<3>;
} // namespace Gemmule
