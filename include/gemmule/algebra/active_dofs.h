// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/block_numbering.h>
#include <gemmule/algebra/condensed_indices.h>
#include <gemmule/algebra/unknown_partition.h>

#include <deal.II/base/partitioner.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <memory>
#include <vector>

namespace Gemmule
{
/**
 * Numbers the degrees of freedom that take part in an unfitted discretisation: those of the active cells, and
 * the masters of their constrained ones, iterated to closure (doc/method-flow.md; FE_Nothing is
 * avoided because of spurious constraints at hanging nodes). Constrained and inactive dofs get no number.
 */
template <int dim>
class ActiveDofs
{
public:
  using Index = UnknownPartition::Index;

  /**
   * @param dof_handler continuous element on the whole mesh
   * @param constraints hanging nodes and boundary values, closed; kept by reference
   * @param cell_is_active by active_cell_index; read for locally owned cells
   * @param part_of_component the part of the field to which the unknowns of each component of the element
   * belong (all dofs of a component alike); empty: one part
   * Collective.
   */
  void reinit(const dealii::DoFHandler<dim> &dof_handler,
              const dealii::AffineConstraints<double> &constraints, const std::vector<bool> &cell_is_active,
              const std::vector<unsigned int> &part_of_component = {});

  /** How the unknowns are distributed. */
  const UnknownPartition &partition() const { return unknowns; }

  /** Number of unknowns on all ranks. */
  Index size() const { return unknowns.size(); }

  /** Gives the unknowns their numbers in a system, of which this is the given field. */
  void renumber(const BlockNumbering &numbering, unsigned int field);

  /** Number of a locally relevant dof, or dealii::numbers::invalid_dof_index. */
  Index number(const dealii::types::global_dof_index dof) const
  {
    return numbers[layout->global_to_local(dof)];
  }

  /** Values of the owned dofs from a vector of the system; zero for dofs without a number. */
  void copy_to_dofs(const dealii::LinearAlgebra::distributed::Vector<double> &solution,
                    std::vector<double> &by_dof) const;
  /** The reverse, for the dofs that have a number; the mesh must still be the same. */
  void copy_from_dofs(const std::vector<double> &by_dof,
                      dealii::LinearAlgebra::distributed::Vector<double> &solution) const;

  /** Appends local dofs to an element; CondensedIndices::sort() must follow once all are appended. */
  void append(const std::vector<dealii::types::global_dof_index> &dofs, CondensedIndices &element) const;

private:
  const dealii::AffineConstraints<double> *constraints = nullptr;
  std::shared_ptr<const dealii::Utilities::MPI::Partitioner> layout; ///< of the dofs
  std::vector<Index> numbers;                                        ///< of owned dofs, then of ghosts
  UnknownPartition unknowns;
};
} // namespace Gemmule
