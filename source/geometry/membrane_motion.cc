#include <gemmule/geometry/membrane_motion.h>

namespace Gemmule
{
using namespace dealii;

template <int dim>
MembraneMotion<dim>::MembraneMotion(const MembraneProjection<dim> &projection, const double dt,
                                    const double dt_previous)
    : projection(projection), dt(dt)
{
  const double r = dt_previous > 0. ? dt / dt_previous : 0.;
  velocity_weight = 1. + r;
  previous_velocity_weight = -r;
  displacement_weight = r * r / (1. + r); // a2
  inverse_a0 = (1. + r) / (1. + 2. * r);
}

template <int dim>
Tensor<1, dim> MembraneMotion<dim>::displacement(const ClosestPoint<dim> &p) const
{
  using Fields = MembraneFields<dim>;
  const Tensor<1, dim> velocity = velocity_weight * projection.value(p, &Fields::velocity) +
                                  previous_velocity_weight * projection.value(p, &Fields::previous_velocity);
  return inverse_a0 * (dt * velocity + displacement_weight * projection.value(p, &Fields::displacement));
}

template <int dim>
typename MembraneMotion<dim>::Trajectory MembraneMotion<dim>::trace_back(const Point<dim> &x) const
{
  using Fields = MembraneFields<dim>;
  Trajectory result;
  result.foot = projection.project(x);
  const double tolerance = 1e-12 * projection.get_patches()[result.foot.patch].size;
  for (unsigned int iteration = 0; iteration < 10; ++iteration)
  {
    const Tensor<1, dim> d = displacement(result.foot);
    const double change = (d - result.displacement).norm();
    result.displacement = d;
    if (change < tolerance)
      break;
    result.foot = projection.project(x - d, result.foot);
  }
  result.velocity = velocity_weight * projection.value(result.foot, &Fields::velocity) +
                    previous_velocity_weight * projection.value(result.foot, &Fields::previous_velocity);
  return result;
}

template class MembraneMotion<2>;
template class MembraneMotion<3>;
} // namespace Gemmule
