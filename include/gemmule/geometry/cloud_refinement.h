// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/geometry/membrane_snapshot.h>

#include <deal.II/distributed/tria.h>

#include <optional>

namespace Gemmule
{
/**
 * The quadrature points of an earlier membrane, as fine as the mesh has become.
 *
 * The points of a cloud are Gauss points of the cells that the membrane cut when it was at its time level.
 * Sums over them are accurate for functions that are smooth on those cells. Where cells have been refined
 * since, the test functions have kinks in between, and some of the new cells hold too few points: the trace
 * of f would jump from one new cell to the next. There the points are replaced by those of the new cells, on
 * the same polynomials of level set and concentrations. Measure and both masses of the points that are
 * replaced are kept exactly.
 *
 * @return nothing where no cell has become finer. The same on all ranks. Collective.
 */
template <int dim>
std::optional<MembraneCloud<dim>>
refined_cloud(const MembraneSnapshot<dim> &snapshot,
              const dealii::parallel::distributed::Triangulation<dim> &triangulation);
} // namespace Gemmule
