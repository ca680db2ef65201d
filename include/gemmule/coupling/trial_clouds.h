// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/coupling/history.h>

#include <deal.II/distributed/tria.h>

#include <optional>

namespace Gemmule
{
/**
 * The quadrature points of the accepted membranes as one try needs them: with the points that the cells of
 * the present mesh ask for, where these are finer than those of the time (refined_cloud()). They belong to
 * the try; the history keeps the points that it has.
 */
template <int dim>
class TrialClouds
{
public:
  using Triangulation = dealii::parallel::distributed::Triangulation<dim>;

  /** Both are kept by reference. Collective. */
  TrialClouds(const History<dim> &history, const Triangulation &triangulation);

  /** To be called after each change of the mesh. Collective. */
  void reinit_mesh();

  const MembraneCloud<dim> &level_n() const { return refined_n ? *refined_n : history.level_n().cloud; }
  /** nullptr if level n is the first one. */
  const MembraneCloud<dim> *level_n_minus_1() const;

private:
  const History<dim> &history;
  const Triangulation &triangulation;
  std::optional<MembraneCloud<dim>> refined_n, refined_n_minus_1; ///< nothing: the history's will do
};
} // namespace Gemmule
