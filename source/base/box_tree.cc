// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/box_tree.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/exceptions.h>
#include <deal.II/numerics/rtree.h>

#include <algorithm>
#include <boost/geometry/index/rtree.hpp>
#include <iterator>
#include <limits>
#include <utility>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // The tree finds distances up to round-off; boxes that are so much farther may be as near as the nearest.
  constexpr double tie = 1. + 1e-12;
} // namespace

template <int dim>
struct BoxTree<dim>::Tree
{
  std::vector<Box> boxes;
  RTree<std::pair<BoundingBox<dim>, unsigned int>> index;
};

template <int dim>
double BoxTree<dim>::Box::distance_square(const Point<dim> &x) const
{
  double sum = 0.;
  for (unsigned int d = 0; d < dim; ++d)
  {
    const double outside = std::max({lower[d] - x[d], x[d] - upper[d], 0.});
    sum += outside * outside;
  }
  return sum;
}

template <int dim>
BoxTree<dim>::BoxTree(std::vector<Box> boxes)
{
  std::vector<std::pair<BoundingBox<dim>, unsigned int>> leaves;
  leaves.reserve(boxes.size());
  for (unsigned int i = 0; i < boxes.size(); ++i)
    leaves.emplace_back(BoundingBox<dim>({boxes[i].lower, boxes[i].upper}), i);
  tree = std::make_unique<const Tree>(Tree{std::move(boxes), pack_rtree(leaves)});
}

template <int dim>
BoxTree<dim>::~BoxTree() = default;

template <int dim>
BoxTree<dim>::BoxTree(BoxTree &&) noexcept = default;

template <int dim>
BoxTree<dim> &BoxTree<dim>::operator=(BoxTree &&) noexcept = default;

template <int dim>
bool BoxTree<dim>::empty() const
{
  return tree->boxes.empty();
}

template <int dim>
unsigned int BoxTree<dim>::nearest(const Point<dim> &x) const
{
  Assert(!empty(), ExcMessage("There is no box at all."));
  namespace bgi = boost::geometry::index;
  const auto &boxes = tree->boxes;
  std::vector<std::pair<BoundingBox<dim>, unsigned int>> found;
  // Mostly there is one nearest box, and a second one is enough to know that.
  for (std::size_t n = 2;; n = std::min(4 * n, boxes.size()))
  {
    found.clear();
    tree->index.query(bgi::nearest(x, n), std::back_inserter(found));
    double best = std::numeric_limits<double>::infinity(), farthest = 0.;
    unsigned int nearest = 0;
    for (const auto &leaf : found)
    {
      const unsigned int i = leaf.second;
      const double distance_square = boxes[i].distance_square(x);
      farthest = std::max(farthest, distance_square);
      if (distance_square < best || (distance_square == best && i < nearest))
      {
        best = distance_square;
        nearest = i;
      }
    }
    if (farthest > best * tie || n >= boxes.size())
      return nearest;
  }
}

template class BoxTree<2>;
template class BoxTree<3>;
} // namespace Gemmule
