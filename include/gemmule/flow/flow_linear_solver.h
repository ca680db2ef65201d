// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/linear_solver.h>
#include <gemmule/flow/flow_structure.h>

#include <functional>
#include <memory>

namespace Gemmule
{
/** A linear solver that is made for the equations of the flow, and may ask for more than their matrix. */
class FlowLinearSolver : public LinearSolver
{
public:
  using StructureSource = std::function<std::unique_ptr<const FlowStructure>()>;

  /**
   * @param source finds the structure of the equations that were prepared last; collective. It is called from
   * prepare() or solve(), if at all.
   */
  void set_structure_source(StructureSource source) { find_structure = std::move(source); }

protected:
  StructureSource find_structure;
};
} // namespace Gemmule
