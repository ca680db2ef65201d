// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/cartesian_index.h>
#include <gemmule/geometry/curve_order.h>

#include <deal.II/base/exceptions.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace Gemmule
{
using namespace dealii;

namespace
{
  constexpr unsigned int none = static_cast<unsigned int>(-1);

  /**
   * The nearest point ahead of point @p i among @p candidates, or none; if @p strict, within 45 degrees of
   * the tangent and with a similar normal.
   */
  unsigned int nearest_ahead(const unsigned int i, const std::vector<unsigned int> &candidates,
                             const std::vector<Point<2>> &points, const std::vector<Tensor<1, 2>> &normals,
                             const bool strict)
  {
    const Tensor<1, 2> tangent({-normals[i][1], normals[i][0]});
    double best = std::numeric_limits<double>::max();
    unsigned int nearest = none;
    for (const unsigned int j : candidates)
    {
      const Tensor<1, 2> difference = points[j] - points[i];
      const double along = difference * tangent, across = std::abs(difference * normals[i]);
      if (j == i || along <= 0. || (strict && (across > along || normals[i] * normals[j] <= 0.)))
        continue;
      const double distance = difference.norm_square();
      if (distance < best)
      {
        best = distance;
        nearest = j;
      }
    }
    return nearest;
  }

  /** Sorts from left to right and, where that differs by @p round_off only, upwards. */
  std::pair<std::int64_t, double> place_of(const Point<2> &p, const double round_off)
  {
    return {std::llround(p[0] / round_off), p[1]};
  }

  /** For each point the one that follows on its curve, or none. */
  std::vector<unsigned int> find_successors(const std::vector<Point<2>> &points,
                                            const std::vector<Tensor<1, 2>> &normals,
                                            const double largest_spacing)
  {
    const unsigned int n = points.size();
    PointBins<2> bins(Point<2>(), 3. * largest_spacing);
    for (unsigned int i = 0; i < n; ++i)
      bins.insert(points[i], i);

    std::vector<unsigned int> successor(n, none);
    std::vector<unsigned int> candidates;
    for (unsigned int i = 0; i < n; ++i)
    {
      candidates.clear();
      bins.visit_nearby(points[i], [&](const unsigned int j) { candidates.push_back(j); });
      successor[i] = nearest_ahead(i, candidates, points, normals, true);
      if (successor[i] == none) // a corner
        successor[i] = nearest_ahead(i, candidates, points, normals, false);
    }
    return successor;
  }

  /** The closed curves; points in excess, where the spacing is uneven, lead into one from the side. */
  std::vector<std::vector<unsigned int>> find_cycles(const std::vector<unsigned int> &successor)
  {
    const unsigned int n = successor.size();
    std::vector<std::vector<unsigned int>> curves;
    constexpr unsigned int not_reached = 0;
    std::vector<unsigned int> reached_from(n, not_reached); // the walk that came there first, counted from 1
    for (unsigned int start = 0; start < n; ++start)
    {
      unsigned int i = start;
      while (i != none && reached_from[i] == not_reached)
      {
        reached_from[i] = start + 1;
        i = successor[i];
      }
      if (i == none || reached_from[i] != start + 1)
        continue;
      curves.emplace_back();
      const unsigned int first = i;
      do
      {
        curves.back().push_back(i);
        i = successor[i];
      } while (i != first);
    }
    return curves;
  }

  /** Puts each point that is on none of the curves behind its nearest neighbour on them. */
  void insert_strays(const std::vector<Point<2>> &points, std::vector<std::vector<unsigned int>> &curves)
  {
    const unsigned int n = points.size();
    std::vector<bool> is_on_curve(n, false);
    for (const auto &curve : curves)
      for (const unsigned int i : curve)
        is_on_curve[i] = true;
    for (unsigned int i = 0; i < n; ++i)
      if (!is_on_curve[i])
      {
        double best = std::numeric_limits<double>::max();
        std::pair<unsigned int, unsigned int> place(none, 0);
        for (unsigned int c = 0; c < curves.size(); ++c)
          for (unsigned int k = 0; k < curves[c].size(); ++k)
            if (const double distance = points[i].distance_square(points[curves[c][k]]); distance < best)
            {
              best = distance;
              place = {c, k};
            }
        if (place.first == none)
          curves.push_back({i});
        else
          curves[place.first].insert(curves[place.first].begin() + place.second + 1, i);
      }
  }
} // namespace

std::vector<std::vector<unsigned int>> order_closed_curves(const std::vector<Point<2>> &points,
                                                           const std::vector<Tensor<1, 2>> &normals,
                                                           const std::vector<double> &spacing)
{
  AssertDimension(points.size(), normals.size());
  AssertDimension(points.size(), spacing.size());
  const unsigned int n = points.size();
  std::vector<std::vector<unsigned int>> curves;
  if (n == 0)
    return curves;

  const double largest_spacing = *std::max_element(spacing.begin(), spacing.end());
  curves = find_cycles(find_successors(points, normals, largest_spacing));
  insert_strays(points, curves);

  // A symmetric membrane has two leftmost points: which of them is first must not hang on the last digit.
  const double round_off = 1e-6 * largest_spacing;
  const auto comes_before = [&](const unsigned int i, const unsigned int j)
  { return place_of(points[i], round_off) < place_of(points[j], round_off); };
  for (auto &curve : curves)
    std::rotate(curve.begin(), std::min_element(curve.begin(), curve.end(), comes_before), curve.end());
  std::sort(curves.begin(), curves.end(),
            [&](const auto &a, const auto &b) { return comes_before(a.front(), b.front()); });
  return curves;
}
} // namespace Gemmule
