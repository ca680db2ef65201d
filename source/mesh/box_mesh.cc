// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/mesh/box_mesh.h>

#include <deal.II/grid/grid_generator.h>

namespace Gemmule
{
using namespace dealii;

template <int dim>
void make_box_mesh(parallel::distributed::Triangulation<dim> &triangulation, const Parameters::Domain &domain,
                   const unsigned int level)
{
  // Parameters::Domain::check() has made sure that the ratios are integers.
  GridGenerator::subdivided_hyper_rectangle(triangulation, domain.coarse_cells(), domain.lower<dim>(),
                                            domain.upper<dim>());
  triangulation.refine_global(level);
}

template void make_box_mesh(parallel::distributed::Triangulation<2> &, const Parameters::Domain &,
                            unsigned int);
template void make_box_mesh(parallel::distributed::Triangulation<3> &, const Parameters::Domain &,
                            unsigned int);
} // namespace Gemmule
