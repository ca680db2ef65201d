// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/geometry/cut_geometry.h>

namespace Gemmule
{
/** Moments of the region that the membrane encloses. */
template <int dim>
struct RegionMoments
{
  double volume = 0.; ///< area in 2D
  dealii::Point<dim> centroid;
  dealii::Tensor<1, dim> second_moments; ///< int (x_d - centroid_d)^2

  /** (a - b)/(a + b) with a = 2 sqrt(Mxx / A), b = 2 sqrt(Myy / A): that of an ellipse along the axes. */
  double deformation() const;
};

/** By the rules of the cut cells, and exactly on the others. Collective. */
template <int dim>
RegionMoments<dim> compute_region_moments(const dealii::Triangulation<dim> &triangulation,
                                          const CutGeometry<dim> &geometry);
} // namespace Gemmule
