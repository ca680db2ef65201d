// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/linear_system.h>
#include <gemmule/flow/cut_cell_matrix.h>
#include <gemmule/flow/extra_field_preconditioner.h>
#include <gemmule/flow/unfitted_stokes_space.h>

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <memory>
#include <vector>

namespace Gemmule
{
/** What a preconditioner has to know of the flow beyond the matrix and its blocks. */
struct FlowStructure
{
  using Index = BlockNumbering::Index;

  unsigned int n_components = 0;
  /** The places of velocity unknowns, of both fluids: each has one unknown for each component. */
  dealii::IndexSet owned_nodes;
  /** Of each owned node the unknowns of its components one after the other, in the numbering of the system.
   */
  std::vector<Index> node_unknowns;
  /**
   * The linear functions of each fluid that vanish at the walls, in the nodes: one row per node, one column
   * per vertex.
   */
  dealii::TrilinosWrappers::SparseMatrix prolongation;
  /** int p q / eta over the part of the box that each fluid occupies; other rows are empty. */
  SubassembledMatrix pressure_mass{true};
  /** For each block of an extra field; nullptr: the block itself has to do. */
  std::vector<std::unique_ptr<const ExtraFieldPreconditioner>> extra_fields;
};

/**
 * All but the extra fields.
 * @param space its numbers are those of @p system, whose elements are finished. Collective.
 */
template <int dim>
std::unique_ptr<FlowStructure> find_flow_structure(const UnfittedStokesSpace<dim> &space,
                                                   const CutGeometry<dim> &geometry, const FluidPair &fluids,
                                                   const LinearSystem &system);
} // namespace Gemmule
