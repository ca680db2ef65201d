// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/interface_velocity.h>
#include <gemmule/surface/trace_space.h>

namespace Gemmule
{
/**
 * A trace field whose values are unknowns of the flow's system besides velocity and pressure (FlowTerm): its
 * unknowns are a block of their own, and each cell of its active mesh has an element that couples them to the
 * flow.
 */
template <int dim>
class ExtraField
{
public:
  static constexpr unsigned int n = TraceSpace<dim>::Basis::n;
  /** Where the unknowns of the field begin in the element of a cut cell. */
  static constexpr unsigned int n_flow = 2 * StokesLayout<dim>::n;

  /** @param space prepared for the geometry of the flow; must stay as long as this is used
   * @param field number of the field in the numbering of the system */
  ExtraField(const TraceSpace<dim> &space, const unsigned int field) : trace_space(&space), field(field) {}

  /**
   * Adds one element per cell of the active mesh: on a cut cell the unknowns of the flow, both fluids, then
   * those of the field; on other cells those of the field alone. The elements of the flow are there already.
   * @param flow_elements condensed indices of the flow on each cut cell, in the numbering of the system
   */
  void add_elements(const std::vector<CondensedIndices> &flow_elements, LinearSystem &system);

  const TraceSpace<dim> &space() const { return *trace_space; }
  /** The element of cell @p b of the active mesh. */
  unsigned int element(const unsigned int b) const { return elements[b]; }

  /** right_side += @p values, a vector of a system of this field alone, complete on its owners. */
  void add_to(LinearSystem::Vector &right_side, const LinearSystem &system,
              const LinearSystem::Vector &values) const;

  /** The field of a ghosted solution on the cut cells. */
  TraceField<dim> extract(const LinearSystem &system, const LinearSystem::Vector &solution) const;

private:
  const TraceSpace<dim> *trace_space;
  unsigned int field;
  std::vector<unsigned int> elements; ///< by cell of the active mesh
};
} // namespace Gemmule
