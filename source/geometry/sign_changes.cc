// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/geometry/sign_changes.h>

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>

namespace Gemmule
{
using namespace dealii;

namespace
{
  constexpr double zero_tolerance = 1e-12; // in steps
  constexpr std::size_t most_iterations = 100;

  /** Any orthonormal basis of the directions orthogonal to @p normal. */
  template <int dim>
  std::array<Tensor<1, dim>, dim - 1> tangents_of(const Tensor<1, dim> &normal)
  {
    std::array<Tensor<1, dim>, dim - 1> tangents;
    if constexpr (dim == 2)
      tangents[0] = cross_product_2d(normal);
    else
    {
      unsigned int smallest = 0;
      for (unsigned int d = 1; d < dim; ++d)
        if (std::abs(normal[d]) < std::abs(normal[smallest]))
          smallest = d;
      Tensor<1, dim> axis;
      axis[smallest] = 1.;
      tangents[0] = cross_product_3d(normal, axis);
      tangents[0] /= tangents[0].norm();
      tangents[1] = cross_product_3d(normal, tangents[0]);
    }
    return tangents;
  }

  /** Slope and second derivative of the zero set as a graph over a line through @p point. */
  struct GraphDerivatives
  {
    double slope, second;
  };

  template <int dim>
  std::optional<GraphDerivatives> graph_along(const Function<dim> &function, const Point<dim> &point,
                                              const Tensor<1, dim> &normal, const Tensor<1, dim> &tangent,
                                              const double radius)
  {
    const double reach = 4. * radius;
    const auto after = nearest_sign_change(function, point + radius * tangent, normal, reach),
               before = nearest_sign_change(function, point - radius * tangent, normal, reach);
    if (!after || !before)
      return {};
    return GraphDerivatives{(*after - *before) / (2. * radius), (*after + *before) / (radius * radius)};
  }

  /** Turns @p normal until the zero set is level beside @p point. @return whether that was possible */
  template <int dim>
  bool turn_to_normal(const Function<dim> &function, const Point<dim> &point, const double radius,
                      Tensor<1, dim> &normal)
  {
    constexpr unsigned int most_turns = 6;
    constexpr double level = 1e-3;
    for (unsigned int i = 0; i < most_turns; ++i)
    {
      double steepest = 0.;
      Tensor<1, dim> turned = normal;
      for (const auto &tangent : tangents_of(normal))
      {
        const auto graph = graph_along(function, point, normal, tangent, radius);
        if (!graph)
          return false;
        turned -= graph->slope * tangent;
        steepest = std::max(steepest, std::abs(graph->slope));
      }
      normal = turned / turned.norm();
      if (steepest < level)
        break;
    }
    return true;
  }
} // namespace

template <int dim>
std::optional<double> first_sign_change(const Function<dim> &function, const Point<dim> &x,
                                        const Tensor<1, dim> &direction, const double step,
                                        const double reach)
{
  const auto value = [&](const double t) { return function.value(x + t * direction); };
  double before = 0., value_before = value(0.);
  while (before < reach)
  {
    const double after = std::min(before + step, reach), value_after = value(after);
    if ((value_after < 0.) != (value_before < 0.))
    {
      if (value_before == 0.)
        return before;
      if (value_after == 0.)
        return after;
      std::uintmax_t n_iterations = most_iterations;
      const auto bracket = boost::math::tools::toms748_solve(
          value, before, after, value_before, value_after,
          [step](const double a, const double b) { return std::abs(b - a) < zero_tolerance * step; },
          n_iterations);
      return 0.5 * (bracket.first + bracket.second);
    }
    before = after;
    value_before = value_after;
  }
  return {};
}

template <int dim>
std::optional<double> nearest_sign_change(const Function<dim> &function, const Point<dim> &x,
                                          const Tensor<1, dim> &direction, const double reach)
{
  constexpr double first_part = 1. / 64., growth = 4.;
  for (double part = first_part; part <= 1.; part *= growth)
  {
    const auto forwards = first_sign_change(function, x, direction, part * reach, part * reach),
               backwards = first_sign_change(function, x, -direction, part * reach, part * reach);
    if (forwards && (!backwards || *forwards <= *backwards))
      return *forwards;
    if (backwards)
      return -*backwards;
  }
  return {};
}

template <int dim>
std::optional<ZeroSetFrame<dim>> zero_set_frame(const Function<dim> &function, const Point<dim> &point,
                                                const double radius)
{
  ZeroSetFrame<dim> frame;
  frame.point = point;
  // Along some axis the zero set is not too steep a graph.
  bool is_graph = false;
  for (unsigned int d = 0; d < dim && !is_graph; ++d)
  {
    frame.normal = Tensor<1, dim>();
    frame.normal[d] = 1.;
    is_graph = turn_to_normal(function, point, radius, frame.normal);
  }
  if (!is_graph)
    return {};
  if (function.value(point + radius * frame.normal) < 0.)
    frame.normal *= -1.;
  frame.tangents = tangents_of(frame.normal);

  for (unsigned int i = 0; i < dim - 1; ++i)
    for (unsigned int j = 0; j <= i; ++j)
    {
      const Tensor<1, dim> sum = frame.tangents[i] + frame.tangents[j];
      const auto graph = graph_along(function, point, frame.normal, sum / sum.norm(), radius);
      if (!graph)
        return {};
      frame.curvature[i][j] =
          i == j ? -graph->second : -graph->second - 0.5 * (frame.curvature[i][i] + frame.curvature[j][j]);
    }
  return frame;
}

#define GEMMULE_INSTANTIATE(dim)                                                                             \
  template std::optional<double> first_sign_change(const Function<dim> &, const Point<dim> &,                \
                                                   const Tensor<1, dim> &, double, double);                  \
  template std::optional<double> nearest_sign_change(const Function<dim> &, const Point<dim> &,              \
                                                     const Tensor<1, dim> &, double);                        \
  template std::optional<ZeroSetFrame<dim>> zero_set_frame(const Function<dim> &, const Point<dim> &, double);
GEMMULE_INSTANTIATE(2)
GEMMULE_INSTANTIATE(3)
#undef GEMMULE_INSTANTIATE
} // namespace Gemmule
