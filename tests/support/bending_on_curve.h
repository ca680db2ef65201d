// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/bending_force.h>
#include <gemmule/model/bending_model.h>
#include <gemmule/surface/membrane_bending.h>

#include "support/ellipse_distance.h"
#include "support/surface_harness.h"

namespace Gemmule::Testing
{
/** Curvature, moment and bending force on an ellipse, for a given composition. */
struct BendingOnCurve
{
  SurfaceHarness harness;
  BendingModel model;
  MembraneBending<2> bending;
  InterfaceVelocity<2> interface_velocity;

  BendingOnCurve(const unsigned int level, const Parameters::Bending &parameters,
                 const std::function<bool(const Point<2> &)> &refine = {})
      : harness(level), model(parameters), bending(harness.mesh.triangulation, model)
  {
    if (refine)
      harness.mesh.refine_where(refine);
    bending.reinit_mesh();
  }

  void set_membrane(const Function<2> &distance)
  {
    harness.set_membrane(distance);
    bending.compute_curvature(harness.interface);
    interface_velocity.reinit(harness.geometry);
  }

  /** Q2 interpolant on the cut cells. */
  TraceField<2> trace_field(const SurfaceHarness::Field &function) const
  {
    TraceField<2> field(harness.geometry.cut_cells().size());
    for (unsigned int k = 0; k < field.size(); ++k)
      for (unsigned int i = 0; i < field[k].size(); ++i)
        field[k][i] = function(harness.geometry.cut_cells()[k].physical(TensorLagrange<2, 2>::node(i)));
    return field;
  }

  void set_composition(const SurfaceHarness::Field &composition)
  {
    const auto f = trace_field(composition), total = trace_field([](const Point<2> &) { return 1.; });
    bending.compute_moment(&f, &total);
  }

  /** dE_b[v] of the discrete force functional. */
  double variation(const SurfaceHarness::VectorField &v) const
  {
    std::vector<MembraneVelocity<2>> velocity(harness.geometry.cut_cells().size());
    for (unsigned int k = 0; k < velocity.size(); ++k)
    {
      const auto &cell = harness.geometry.cut_cells()[k];
      velocity[k].cell_size = cell.size;
      for (unsigned int i = 0; i < velocity[k].nodal.size(); ++i)
        velocity[k].nodal[i] = v(cell.physical(TensorLagrange<2, 2>::node(i)));
    }
    return Utilities::MPI::sum(BendingForce<2>(bending, 1.).power(interface_velocity, velocity),
                               MPI_COMM_WORLD);
  }

  /** L2 error of the curvature. */
  double curvature_error(const SurfaceHarness::Field &exact) const
  {
    double sum = 0.;
    for (unsigned int k = 0; k < harness.geometry.cut_cells().size(); ++k)
    {
      const auto &cell = harness.geometry.cut_cells()[k];
      for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
      {
        const double e = bending.curvature()[k][q] - exact(cell.physical(cell.surface_points[q]));
        sum += cell.surface_weights[q] * e * e;
      }
    }
    return std::sqrt(Utilities::MPI::sum(sum, MPI_COMM_WORLD));
  }
};

/**
 * The bending energy of the curve X + eps v(X), X on an ellipse, with the composition that the points X had:
 * trapezoidal rule and differences of eighth order on a periodic grid.
 */
class ParametricBending
{
public:
  ParametricBending(const Point<2> &centre, const double a, const double b, const BendingModel &model,
                    SurfaceHarness::Field composition)
      : centre(centre), a(a), b(b), model(model), composition(std::move(composition))
  {
  }

  double energy(const double eps, const SurfaceHarness::VectorField &v) const
  {
    std::vector<Point<2>> x(n);
    std::vector<double> c(n);
    for (unsigned int i = 0; i < n; ++i)
    {
      const double t = 2. * numbers::PI * i / n;
      const Point<2> X = centre + Point<2>(a * std::cos(t), b * std::sin(t));
      x[i] = X + eps * v(X);
      c[i] = composition(X);
    }
    const double dt = 2. * numbers::PI / n;
    double sum = 0.;
    for (unsigned int i = 0; i < n; ++i)
    {
      const auto at = [&](const int k) { return x[(i + n + k) % n]; };
      constexpr double d1[] = {4. / 5., -1. / 5., 4. / 105., -1. / 280.};
      constexpr double d2[] = {8. / 5., -1. / 5., 8. / 315., -1. / 560.};
      Tensor<1, 2> first, second = -205. / 72. * Tensor<1, 2>(at(0));
      for (int k = 1; k <= 4; ++k)
      {
        first += d1[k - 1] * (at(k) - at(-k));
        second += d2[k - 1] * (Tensor<1, 2>(at(k)) + Tensor<1, 2>(at(-k)));
      }
      first /= dt;
      second /= dt * dt;
      const double speed = first.norm();
      const double curvature = (first[0] * second[1] - first[1] * second[0]) / (speed * speed * speed);
      sum += dt * speed * model.evaluate(curvature, c[i]).energy;
    }
    return sum;
  }

  double variation(const SurfaceHarness::VectorField &v) const
  {
    const double eps = 1e-4;
    return (8. * (energy(eps, v) - energy(-eps, v)) - (energy(2. * eps, v) - energy(-2. * eps, v))) /
           (12. * eps);
  }

  /** Curvature of the ellipse at the point closest in angle; exact on it. */
  double curvature(const Point<2> &x) const
  {
    const double t = std::atan2((x[1] - centre[1]) / b, (x[0] - centre[0]) / a);
    return a * b / std::pow(a * a * std::sin(t) * std::sin(t) + b * b * std::cos(t) * std::cos(t), 1.5);
  }

private:
  static constexpr int n = 400;
  Point<2> centre;
  double a, b;
  const BendingModel &model;
  SurfaceHarness::Field composition;
};
} // namespace Gemmule::Testing
