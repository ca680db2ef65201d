// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/parameters/domain.h>

#include <deal.II/distributed/tria.h>

namespace Gemmule
{
/** The box [lower, upper] as a mesh of cubes; its shortest edge has 2^level cells. Throws UserError. */
template <int dim>
void make_box_mesh(dealii::parallel::distributed::Triangulation<dim> &triangulation,
                   const Parameters::Domain &domain, unsigned int level);
} // namespace Gemmule
