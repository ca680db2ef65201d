// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/linear_system.h>
#include <gemmule/flow/unfitted_stokes_space.h>

#include <array>
#include <vector>

namespace Gemmule
{
/**
 * The last flows, of each right side, as guesses for the next ones: what an iterative solver starts from. The
 * unknowns are others once the membrane has moved, so that velocity and pressure of each fluid are kept by
 * the dofs of the mesh; dofs that had no value get zero, and so do extra fields.
 */
template <int dim>
class FlowGuess
{
public:
  /** After a change of the mesh, or where the past must not matter. */
  void forget() { flows.clear(); }

  /** @param flows one for each right side. */
  void remember(const UnfittedStokesSpace<dim> &space, const std::vector<LinearSystem::Vector> &flows);

  /** @param guesses zero on entry; those of which nothing is known stay so */
  void recall(const UnfittedStokesSpace<dim> &space, std::vector<LinearSystem::Vector> &guesses) const;

private:
  std::vector<std::array<std::vector<double>, 2>> flows; ///< of each right side and fluid
};
} // namespace Gemmule
