// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/geometry/sign_changes.h>
#include <gemmule/geometry/zero_set_distance.h>

#include <deal.II/numerics/rtree.h>

#include <cmath>
#include <limits>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // In spacings of the known points: where points are projected, and over which distance signs around a known
  // point tell its tangent and curvature.
  constexpr double near = 3.;
  constexpr double radius_of_signs = 0.02;
  // Up to the first slope of its parabola a frame is accurate, and up to the second the next one is made from
  // it; inside of the centres of curvature it is of use up to this determinant.
  constexpr double close_slope = 0.25, largest_slope = 0.5, smallest_determinant = 0.2;
  constexpr unsigned int most_projections = 4;
  // So many known points are compared, with their parabolas up to this many spacings along the tangent.
  constexpr unsigned int n_candidates = 16;
  constexpr double reach_of_parabola = 1.5;
  constexpr double much_nearer = 0.5;
  // Steps of the search across a layer, in parts of its reach.
  constexpr unsigned int n_steps_across_layer = 16;
} // namespace

/** The points, found by place, with their frames, which are computed when they are asked for. */
template <int dim>
class ZeroSetDistance<dim>::KnownPoints
{
public:
  KnownPoints(const Function<dim> &function, const std::vector<KnownPoint> &points)
      : points(points), function(function), tree(pack_rtree(places(points))), frames(points.size()),
        is_known(points.size(), false)
  {
  }

  unsigned int nearest(const Point<dim> &x) const { return nearest(x, 1).front(); }

  /** Some of the nearest points, in no order. */
  std::vector<unsigned int> nearest(const Point<dim> &x, const unsigned int n) const
  {
    std::vector<Place> found;
    tree.query(boost::geometry::index::nearest(x, n), std::back_inserter(found));
    std::vector<unsigned int> result;
    for (const Place &place : found)
      result.push_back(place.second);
    return result;
  }

  /** About the distance of @p x from the zero set beside a point, by its parabola if that reaches so far. */
  double expected_distance(const unsigned int i, const Point<dim> &x) const
  {
    const Tensor<1, dim> way = x - points[i].point;
    const double distance = way.norm();
    if (!(distance < near * points[i].spacing) || !frame(i))
      return distance;
    Tensor<1, dim - 1> tangential;
    for (unsigned int d = 0; d < dim - 1; ++d)
      tangential[d] = way * frame(i)->tangents[d];
    if (tangential.norm() > reach_of_parabola * points[i].spacing)
      return distance;
    return std::min(distance,
                    std::abs(way * frame(i)->normal +
                             0.5 * (tangential * (Tensor<2, dim - 1>(frame(i)->curvature) * tangential))));
  }

  /** Nothing where the zero set is no graph. */
  const std::optional<ZeroSetFrame<dim>> &frame(const unsigned int i) const
  {
    if (!is_known[i])
      frames[i] = zero_set_frame(function, points[i].point, radius_of_signs * points[i].spacing);
    is_known[i] = true;
    return frames[i];
  }

  const std::vector<KnownPoint> points;

private:
  using Place = std::pair<Point<dim>, unsigned int>;

  static std::vector<Place> places(const std::vector<KnownPoint> &points)
  {
    std::vector<Place> result;
    for (const auto &known : points)
      result.emplace_back(known.point, result.size());
    return result;
  }

  const Function<dim> &function;
  const RTree<Place> tree;
  mutable std::vector<std::optional<ZeroSetFrame<dim>>> frames;
  mutable std::vector<bool> is_known;
};

namespace
{
  /**
   * One step towards the point of the zero set that is closest to @p x: the foot of the perpendicular onto
   * the parabola of @p frame, moved onto the zero set along its normal.
   */
  template <int dim>
  struct Projection
  {
    Point<dim> point;
    Tensor<1, dim> normal; ///< of the parabola, of any length
    bool is_close;         ///< was the foot near enough for the parabola to be accurate?
  };

  /** @return nothing where the frame is of no use. */
  template <int dim>
  std::optional<Projection<dim>> project(const Function<dim> &function, const ZeroSetFrame<dim> &frame,
                                         const Point<dim> &x, const double spacing)
  {
    const Tensor<1, dim> way = x - frame.point;
    const double height = way * frame.normal;
    // The foot s: (1 + height curvature) s = tangential part of the way.
    Tensor<2, dim - 1> matrix;
    Tensor<1, dim - 1> tangential;
    for (unsigned int i = 0; i < dim - 1; ++i)
    {
      tangential[i] = way * frame.tangents[i];
      for (unsigned int j = 0; j < dim - 1; ++j)
        matrix[i][j] = (i == j) + height * frame.curvature[i][j];
    }
    if (determinant(matrix) < smallest_determinant || trace(matrix) < 0.)
      return {};
    Tensor<1, dim - 1> foot = invert(matrix) * tangential;
    Tensor<1, dim - 1> slope = -(Tensor<2, dim - 1>(frame.curvature) * foot);
    Projection<dim> result;
    result.is_close = slope.norm() < close_slope;
    if (slope.norm() > largest_slope)
    {
      foot *= largest_slope / slope.norm();
      slope *= largest_slope / slope.norm();
    }
    result.point = frame.point + 0.5 * (foot * slope) * frame.normal;
    result.normal = frame.normal;
    for (unsigned int i = 0; i < dim - 1; ++i)
    {
      result.point += foot[i] * frame.tangents[i];
      result.normal -= slope[i] * frame.tangents[i];
    }
    const auto correction = nearest_sign_change(function, result.point, frame.normal, spacing);
    if (!correction)
      return {};
    result.point += *correction * frame.normal;
    return result;
  }

  /** Distance of @p x from the zero set, starting from the point of @p frame; nothing where that leads
   * nowhere. */
  template <int dim>
  std::optional<double> projected_distance(const Function<dim> &function, ZeroSetFrame<dim> frame,
                                           const Point<dim> &x, const double spacing)
  {
    for (unsigned int i = 0; i < most_projections; ++i)
    {
      const auto projection = project(function, frame, x, spacing);
      if (!projection)
        return {};
      // From the tangent plane, since the foot is not exact.
      if (projection->is_close)
        return std::abs((x - projection->point) * projection->normal) / projection->normal.norm();
      const auto next = zero_set_frame(function, projection->point, radius_of_signs * spacing);
      if (!next)
        return x.distance(projection->point);
      frame = *next;
    }
    return x.distance(frame.point);
  }
} // namespace

template <int dim>
ZeroSetDistance<dim>::ZeroSetDistance(const Function<dim> &function, const std::vector<KnownPoint> &points)
    : function(function), known_points(std::make_unique<KnownPoints>(function, points))
{
  Assert(!points.empty(), ExcMessage("A zero set without points has no distance."));
}

template <int dim>
ZeroSetDistance<dim>::~ZeroSetDistance() = default;

template <int dim>
double ZeroSetDistance<dim>::value(const Point<dim> &x, const unsigned int) const
{
  const double value_at_x = function.value(x);
  if (value_at_x == 0.)
    return 0.;
  // The nearest point may be one of another sheet, if those of the nearest sheet are farther apart: another
  // one is taken where it promises to be much nearer.
  unsigned int best = known_points->nearest(x);
  double distance = x.distance(known_points->points[best].point);
  double largest = much_nearer * known_points->expected_distance(best, x);
  for (const unsigned int i : known_points->nearest(x, n_candidates))
    if (const double expected = known_points->expected_distance(i, x); expected < largest)
    {
      best = i;
      largest = expected;
    }
  const KnownPoint &known = known_points->points[best];
  if (x.distance(known.point) < near * known.spacing)
    if (const auto &frame = known_points->frame(best))
      distance =
          std::min(distance, projected_distance(function, *frame, x, known.spacing).value_or(distance));
  return std::copysign(distance, value_at_x);
}

template <int dim>
double ZeroSetDistance<dim>::offset(const Point<dim> &x, const Tensor<1, dim> &direction,
                                    const double reach) const
{
  return nearest_sign_change(function, x, direction, reach).value_or(0.);
}

template <int dim>
double ZeroSetDistance<dim>::curvature(const Point<dim> &x) const
{
  const auto &frame = known_points->frame(known_points->nearest(x));
  return frame ? frame->curvature.norm() : std::numeric_limits<double>::infinity();
}

template <int dim>
double ZeroSetDistance<dim>::thinnest_layer(const Point<dim> &x, const double reach) const
{
  const auto &frame = known_points->frame(known_points->nearest(x));
  double thinnest = std::numeric_limits<double>::infinity();
  if (!frame)
    return thinnest;
  const double step = reach / n_steps_across_layer, skipped = 0.5 * step;
  for (const Tensor<1, dim> &direction : {frame->normal, -frame->normal})
    if (const auto change = first_sign_change(function, x + skipped * direction, direction, step, reach))
      thinnest = std::min(thinnest, skipped + *change);
  return thinnest;
}

template <int dim>
double ZeroSetDistance<dim>::layer_thickness(const Point<dim> &x, const double reach) const
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto &frame = known_points->frame(known_points->nearest(x));
  if (!frame)
    return infinity;
  const double step = reach / n_steps_across_layer;
  return first_sign_change(function, x, frame->normal, step, reach).value_or(infinity) +
         first_sign_change(function, x, -frame->normal, step, reach).value_or(infinity);
}

template class ZeroSetDistance<2>;
template class ZeroSetDistance<3>;
} // namespace Gemmule
