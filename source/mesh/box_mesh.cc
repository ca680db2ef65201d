// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/mesh/box_mesh.h>

#include <deal.II/grid/grid_generator.h>

#include <algorithm>
#include <cmath>

namespace Gemmule
{
using namespace dealii;

template <int dim>
Point<dim> lower_corner(const Parameters::Domain &domain)
{
  Point<dim> corner;
  for (unsigned int d = 0; d < dim; ++d)
    corner[d] = domain.lower_corner[d];
  return corner;
}

template <int dim>
void make_box_mesh(parallel::distributed::Triangulation<dim> &triangulation, const Parameters::Domain &domain,
                   const unsigned int level)
{
  const Point<dim> lower = lower_corner<dim>(domain);
  Point<dim> upper;
  double shortest = std::numeric_limits<double>::max();
  for (unsigned int d = 0; d < dim; ++d)
  {
    upper[d] = domain.upper_corner[d];
    shortest = std::min(shortest, upper[d] - lower[d]);
  }
  // Parameters::Domain::check() has made sure that the ratios are integers.
  std::vector<unsigned int> repetitions(dim);
  for (unsigned int d = 0; d < dim; ++d)
    repetitions[d] = static_cast<unsigned int>(std::lround((upper[d] - lower[d]) / shortest));
  GridGenerator::subdivided_hyper_rectangle(triangulation, repetitions, lower, upper);
  triangulation.refine_global(level);
}

template Point<2> lower_corner<2>(const Parameters::Domain &);
template Point<3> lower_corner<3>(const Parameters::Domain &);
template void make_box_mesh(parallel::distributed::Triangulation<2> &, const Parameters::Domain &,
                            unsigned int);
template void make_box_mesh(parallel::distributed::Triangulation<3> &, const Parameters::Domain &,
                            unsigned int);
} // namespace Gemmule
