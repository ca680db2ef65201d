// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/point.h>

#include <memory>
#include <vector>

namespace Gemmule
{
/** Finds which of some boxes (or points) is nearest to a point, in a time that hardly depends on how many
 * there are and how far they lie. */
template <int dim>
class BoxTree
{
public:
  /** A point if both corners are the same. */
  struct Box
  {
    dealii::Point<dim> lower, upper;
    /** Square of the distance of @p x; 0 inside. */
    double distance_square(const dealii::Point<dim> &x) const;
  };

  explicit BoxTree(std::vector<Box> boxes = {});
  ~BoxTree();
  BoxTree(BoxTree &&) noexcept;
  BoxTree &operator=(BoxTree &&) noexcept;

  bool empty() const;

  /** Index of the box that is nearest to @p x, the lowest one if there are several. There has to be one. */
  unsigned int nearest(const dealii::Point<dim> &x) const;

private:
  struct Tree; // keeps the library out of all that include this
  std::unique_ptr<const Tree> tree;
};
} // namespace Gemmule
