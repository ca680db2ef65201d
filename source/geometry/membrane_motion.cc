// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/geometry/level_set_curvature.h>
#include <gemmule/geometry/membrane_motion.h>

#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
MembraneMotion<dim>::MembraneMotion(const MembraneProjection<dim> &projection, const TimeStep &step)
    : projection(projection), dt(step.size()), bdf(step.bdf())
{
}

template <int dim>
Tensor<1, dim> MembraneMotion<dim>::displacement(const ClosestPoint<dim> &p) const
{
  using Fields = MembraneFields<dim>;
  Tensor<1, dim> velocity = bdf.e1 * projection.value(p, &Fields::velocity) +
                            bdf.e2 * projection.value(p, &Fields::velocity_1_back);
  if (added_tension != 0.)
    velocity += added_tension * projection.value(p, &Fields::tension_velocity);
  return bdf.inverse_a0 * (dt * velocity + bdf.a2 * projection.value(p, &Fields::displacement));
}

template <int dim>
typename MembraneMotion<dim>::Trajectory MembraneMotion<dim>::trace_back(const Point<dim> &x) const
{
  using Fields = MembraneFields<dim>;
  Trajectory result;
  result.departure_point = projection.project(x);
  const double tolerance = 1e-12 * projection.get_patches()[result.departure_point.patch].size;
  for (unsigned int iteration = 0; iteration < 10; ++iteration)
  {
    const Tensor<1, dim> d = displacement(result.departure_point);
    const double change = (d - result.displacement).norm();
    result.displacement = d;
    if (change < tolerance)
      break;
    result.departure_point = projection.project(x - d, result.departure_point);
  }
  result.velocity = bdf.e1 * projection.value(result.departure_point, &Fields::velocity) +
                    bdf.e2 * projection.value(result.departure_point, &Fields::velocity_1_back);
  if (added_tension != 0.)
    result.velocity += added_tension * projection.value(result.departure_point, &Fields::tension_velocity);
  return result;
}

template <int dim>
double MembraneMotion<dim>::fit_measure(const MembraneCloud<dim> &cloud, const double measure,
                                        const double volume)
{
  using Basis = TensorLagrange<dim, 3>;
  // Displacement and its gradient at the points: given part and part per unit of tension.
  struct PointMotion
  {
    Tensor<1, dim> displacement, displacement_by_tension;
    Tensor<2, dim> deformation, deformation_by_tension;
  };
  std::vector<PointMotion> motion(cloud.points.size());
  double total_curvature = 0.;
  typename Basis::Values values;
  typename Basis::Gradients gradients;
  for (unsigned int i = 0; i < motion.size(); ++i)
  {
    const ClosestPoint<dim> p = projection.project(cloud.points[i]);
    const MembranePatch<dim> &patch = projection.get_patches()[p.patch];
    Basis::evaluate(p.unit_point, values, gradients);
    for (unsigned int d = 0; d < dim; ++d)
      motion[i].deformation[d][d] = 1.;
    for (unsigned int k = 0; k < Basis::n; ++k)
    {
      const Tensor<1, dim> d =
          bdf.inverse_a0 *
          (dt * (bdf.e1 * patch.fields.velocity[k] + bdf.e2 * patch.fields.velocity_1_back[k]) +
           bdf.a2 * patch.fields.displacement[k]);
      const Tensor<1, dim> e = (bdf.inverse_a0 * dt) * patch.fields.tension_velocity[k];
      motion[i].displacement += values[k] * d;
      motion[i].displacement_by_tension += values[k] * e;
      motion[i].deformation += outer_product(d, gradients[k]) / patch.size;
      motion[i].deformation_by_tension += outer_product(e, gradients[k]) / patch.size;
    }
    const auto phi = evaluate_polynomial<dim, 3, 2>(patch.level_set, p.unit_point);
    total_curvature += cloud.weights[i] * level_set_curvature(phi, patch.size);
  }

  // The oriented element of the moved membrane is the cofactor of F = grad(x + d) times that of the old one.
  const auto moved_measure = [&](const double tension)
  {
    double moved = 0., moved_volume = 0.;
    for (unsigned int i = 0; i < motion.size(); ++i)
    {
      const Tensor<2, dim> F = motion[i].deformation + tension * motion[i].deformation_by_tension;
      const Tensor<1, dim> element =
          cloud.weights[i] * determinant(F) * (transpose(invert(F)) * cloud.normals[i]);
      const Tensor<1, dim> x = Tensor<1, dim>(cloud.points[i]) + motion[i].displacement +
                               tension * motion[i].displacement_by_tension;
      moved += element.norm();
      moved_volume += x * element / dim;
    }
    return moved - (moved_volume - volume) / moved * total_curvature;
  };

  added_tension = 0.;
  const double step = 1e-3;
  const double slope = (moved_measure(step) - moved_measure(-step)) / (2. * step);
  if (!(std::abs(slope) > 1e-9 * bdf.inverse_a0 * dt * measure))
    return 0.;
  double tension = 0.;
  for (unsigned int iteration = 0; iteration < 6; ++iteration)
  {
    const double excess = moved_measure(tension) - measure;
    tension -= excess / slope;
    if (std::abs(excess) < 1e-13 * measure)
      break;
  }
  return added_tension = tension;
}

template class MembraneMotion<2>;
template class MembraneMotion<3>;
} // namespace Gemmule
