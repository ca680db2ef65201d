// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/geometry/level_set_curvature.h>
#include <gemmule/geometry/membrane_projection.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // The normal of the nearest sample tells the side if its angle with the direction to a point is below 25
  // degrees.
  constexpr double well_aligned = 0.9;

  // So many rings of bins around a point are searched for the nearest sample; farther away it is the nearest
  // one of each patch that counts.
  constexpr int n_rings = 3;
  // In bins: where the rings have no sample of a patch with this one. A bin is as large as the largest patch.
  constexpr double square_of_far = (n_rings + 2.2) * (n_rings + 2.2) * 3.;

  /** The level set of a patch in units of the cell size. */
  template <int dim>
  PolynomialValue<dim> local_level_set(const MembranePatch<dim> &patch, const Point<dim> &unit_point)
  {
    auto phi = evaluate_polynomial<dim, 3, 2>(patch.level_set, unit_point);
    const double scale = 1. / patch.size;
    phi.value *= scale;
    phi.gradient *= scale;
    phi.hessian *= scale;
    return phi;
  }

  template <int dim>
  bool in_unit_cell(const Point<dim> &p, const double tolerance)
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (p[d] < -tolerance || p[d] > 1. + tolerance)
        return false;
    return true;
  }

  /** Moves a point of the cell along the gradient onto the membrane. @return whether it stays in the cell. */
  template <int dim>
  bool move_onto_membrane(const MembranePatch<dim> &patch, Point<dim> &y)
  {
    for (unsigned int iteration = 0; iteration < 8; ++iteration)
    {
      const auto phi = local_level_set(patch, y);
      const double norm_square = phi.gradient.norm_square();
      if (norm_square < 1e-20)
        return false;
      const Tensor<1, dim> step = -phi.value / norm_square * phi.gradient;
      if (step.norm() > 1.)
        return false;
      y += step;
      if (step.norm() < 1e-8)
        return in_unit_cell(y, 1e-3);
    }
    return false;
  }

  /**
   * Newton's step for the point y of the zero level and the multiplier of (y - target) + multiplier grad phi
   * = 0. @return whether that leads to a minimum of the distance: the matrix has to be positive definite on
   * the tangent space.
   */
  template <int dim>
  bool newton_step(const PolynomialValue<dim> &phi, const Tensor<1, dim> &difference, const double multiplier,
                   Tensor<1, dim> &step, double &multiplier_step)
  {
    const Tensor<1, dim> residual = multiplier * phi.gradient - difference;
    Tensor<2, dim> matrix = multiplier * phi.hessian;
    for (unsigned int d = 0; d < dim; ++d)
      matrix[d][d] += 1.;
    const double tangential_trace =
        trace(matrix) - phi.gradient * (matrix * phi.gradient) / phi.gradient.norm_square();
    // In 3D two negative eigenvalues have a positive product as well.
    if (!(determinant(matrix) > 0.05) || (dim == 3 && !(tangential_trace > 0.)))
      return false;
    const Tensor<2, dim> inverse = invert(matrix);
    const double denominator = phi.gradient * (inverse * phi.gradient);
    if (!(denominator > 1e-3 * phi.gradient.norm_square()))
      return false;
    multiplier_step = (phi.value - phi.gradient * (inverse * residual)) / denominator;
    step = -(inverse * (residual + multiplier_step * phi.gradient));
    return true;
  }
} // namespace

template <int dim>
MembraneProjection<dim>::MembraneProjection(const std::vector<MembranePatch<dim>> &patches_,
                                            const Point<dim> &origin)
    : patches(patches_), patch_map(origin)
{
  if (patches.empty())
    throw StepBreakdown("The membrane has vanished: no cell of the mesh is cut by it any more.");

  double largest_size = 0.;
  for (const auto &patch : patches)
    largest_size = std::max(largest_size, patch.size);
  for (unsigned int p = 0; p < patches.size(); ++p)
  {
    const auto &patch = patches[p];
    patch_map.insert(patch.corner, patch.size, p);

    // Nodes of the cell, moved onto the membrane along the gradient: samples where they stay in the cell.
    const std::size_t first = all_samples.size();
    for (unsigned int i = 0; i < TensorLagrange<dim, 3>::n; ++i)
    {
      Point<dim> y = TensorLagrange<dim, 3>::node(i);
      if (!move_onto_membrane(patch, y))
        continue;
      const auto phi = local_level_set(patch, y);
      all_samples.push_back(
          {patch.corner + patch.size * Tensor<1, dim>(y), phi.gradient / phi.gradient.norm(), y, p});
    }
    if (all_samples.size() > first)
      primary_samples.push_back(first);
  }
  if (all_samples.empty())
    throw StepBreakdown("The membrane has degenerated: no point of it could be found in the cut cells.");

  bins = PointBins<dim>(origin, largest_size);
  for (unsigned int i = 0; i < all_samples.size(); ++i)
    bins.insert(all_samples[i].point, i);
  std::vector<typename BoxTree<dim>::Box> primary_points;
  for (const unsigned int i : primary_samples)
    primary_points.push_back({all_samples[i].point, all_samples[i].point});
  primary_tree = BoxTree<dim>(std::move(primary_points));
}

template <int dim>
unsigned int MembraneProjection<dim>::nearest_sample(const Point<dim> &x) const
{
  // One sample of each patch tells how far the others may lie.
  const unsigned int primary = primary_samples[primary_tree.nearest(x)];
  const double primary_square = x.distance_square(all_samples[primary].point), bin_size = bins.bin_size();
  if (primary_square > square_of_far * bin_size * bin_size)
    return primary;

  double best = std::numeric_limits<double>::max(), reach_square = primary_square;
  unsigned int nearest = primary;
  const auto visit = [&](const unsigned int i)
  {
    const double distance = x.distance_square(all_samples[i].point);
    if (distance < best)
    {
      best = distance;
      reach_square = std::min(reach_square, distance);
      nearest = i;
    }
  };
  // Rings of bins around the point: what lies beyond ring r is at least r bins away.
  for (int ring = 0; ring <= n_rings; ++ring)
  {
    if (ring > 1 && reach_square <= (ring - 1.) * (ring - 1.) * bin_size * bin_size)
      break;
    bins.visit_ring(x, ring, reach_square, visit);
  }
  return best <= primary_square ? nearest : primary;
}

template <int dim>
ClosestPoint<dim> MembraneProjection<dim>::newton(const Point<dim> &x, unsigned int p, Point<dim> y) const
{
  ClosestPoint<dim> result;
  const auto local = [&](const Point<dim> &point)
  { return Point<dim>((point - patches[p].corner) / patches[p].size); };
  Point<dim> target = local(x);
  bool known_multiplier = false;
  double multiplier = 0.;
  unsigned int n_switches = 0;
  for (unsigned int iteration = 0; iteration < 30; ++iteration)
  {
    const auto phi = local_level_set(patches[p], y);
    const double norm_square = phi.gradient.norm_square();
    if (norm_square < 1e-12)
      return result;
    const Tensor<1, dim> difference = target - y;
    if (!known_multiplier)
      multiplier = (difference * phi.gradient) / norm_square;
    known_multiplier = true;
    Tensor<1, dim> step;
    double multiplier_step = 0.;
    if (!newton_step(phi, difference, multiplier, step, multiplier_step))
    {
      // Along the gradient and the tangent plane in turn.
      step = -phi.value / norm_square * phi.gradient +
             0.5 * (difference - (difference * phi.gradient) / norm_square * phi.gradient);
      known_multiplier = false;
    }
    const double length = step.norm();
    if (length > 0.5)
    {
      step *= 0.5 / length;
      known_multiplier = false;
    }
    y += step;
    multiplier += multiplier_step;

    if (!in_unit_cell(y, 1e-3) && n_switches < 12)
    {
      const Point<dim> physical = patches[p].corner + patches[p].size * Tensor<1, dim>(y);
      const int other = patch_map.find(physical);
      if (other >= 0 && static_cast<unsigned int>(other) != p)
      {
        p = other;
        y = local(physical);
        target = local(x);
        known_multiplier = false;
        ++n_switches;
        continue;
      }
    }
    if (length < 1e-7) // quadratic convergence: the next step would be below round-off
    {
      const auto final = local_level_set(patches[p], y);
      result.converged = std::abs(final.value) < 1e-10 && in_unit_cell(y, 0.5);
      result.patch = p;
      result.unit_point = y;
      result.point = patches[p].corner + patches[p].size * Tensor<1, dim>(y);
      result.normal = final.gradient / final.gradient.norm();
      const Tensor<1, dim> offset = x - result.point;
      result.distance = std::copysign(offset.norm(), offset * result.normal);
      return result;
    }
  }
  return result;
}

template <int dim>
ClosestPoint<dim> MembraneProjection<dim>::project(const Point<dim> &x) const
{
  const Sample &sample = all_samples[nearest_sample(x)];
  ClosestPoint<dim> result = newton(x, sample.patch, sample.unit_point);
  const Tensor<1, dim> difference = x - sample.point;
  // Newton may end on another sheet of the membrane; the sample is then the better answer.
  if (!result.converged || std::abs(result.distance) > difference.norm() * (1. + 1e-8) + 1e-12)
  {
    result.converged = false;
    result.patch = sample.patch;
    result.unit_point = sample.unit_point;
    result.point = sample.point;
    result.normal = sample.normal;
    result.distance = std::copysign(difference.norm(), difference * sample.normal);
  }
  return result;
}

template <int dim>
ClosestPoint<dim> MembraneProjection<dim>::project(const Point<dim> &x, const ClosestPoint<dim> &guess) const
{
  if (guess.converged)
  {
    const ClosestPoint<dim> result = newton(x, guess.patch, guess.unit_point);
    if (result.converged && std::abs(result.distance) <= x.distance(guess.point) * (1. + 1e-8) + 1e-12)
      return result;
  }
  return project(x);
}

template <int dim>
double MembraneProjection<dim>::approximate_distance(const Point<dim> &x) const
{
  const Sample &closest = nearest(x);
  const double distance = x.distance(closest.point);
  const auto alignment_of = [&](const Sample &sample)
  {
    const Tensor<1, dim> difference = x - sample.point;
    return difference * sample.normal / std::max(difference.norm(), 1e-300);
  };
  double alignment = alignment_of(closest);
  if (std::abs(alignment) > well_aligned)
    return std::copysign(distance, alignment);

  // Beside a corner: another sample that is hardly farther may tell more.
  bins.visit_nearby(closest.point,
                    [&](const unsigned int i)
                    {
                      const Sample &sample = all_samples[i];
                      if (x.distance(sample.point) < distance + 0.5 * patches[sample.patch].size &&
                          std::abs(alignment_of(sample)) > std::abs(alignment))
                        alignment = alignment_of(sample);
                    });
  return std::copysign(distance, alignment);
}

template <int dim>
double MembraneProjection<dim>::curvature(const Sample &sample) const
{
  const MembranePatch<dim> &patch = patches[sample.patch];
  return level_set_curvature(local_level_set(patch, sample.unit_point), patch.size);
}

template <int dim>
double MembraneProjection<dim>::distance_drift() const
{
  double drift = 0.;
  for (const unsigned int i : primary_samples)
  {
    const auto &sample = all_samples[i];
    drift = std::max(
        drift, std::abs(local_level_set(patches[sample.patch], sample.unit_point).gradient.norm() - 1.));
  }
  return drift;
}

template class MembraneProjection<2>;
template class MembraneProjection<3>;
} // namespace Gemmule
