// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/geometry/cell_level_set.h>

#include <deal.II/base/bounding_box.h>
#include <deal.II/non_matching/quadrature_generator.h>

#include <cmath>

namespace Gemmule
{
/** [0, 1]^dim */
template <int dim>
dealii::BoundingBox<dim> unit_box();

/**
 * A nodal value of the level set of a cell of edge @p size as the rules need it: a zero would be cut or not
 * by round-off, differently in the cells that share the node. It counts as outside.
 */
inline double off_zero(const double value, const double size)
{
  return std::abs(value) < 1e-10 * size ? 1e-10 * size : value;
}

/**
 * Makes the rules of a unit cell that the level set cuts.
 *
 * Where a membrane is torn, the generator may find more roots on a line than it expects. deal.II's debug
 * library asserts that, the other one goes on with a rule that is worse. A trial step of a user is no case
 * for an abort.
 *
 * @return false if an assertion failed; the generator has no rules then
 */
template <int dim>
bool generate_cut_quadrature(dealii::NonMatching::QuadratureGenerator<dim> &generator,
                             const CellLevelSet<dim> &level_set, const dealii::BoundingBox<dim> &unit_box);
} // namespace Gemmule
