// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <deal.II/base/types.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <utility>
#include <vector>

namespace Gemmule
{
/**
 * How the local degrees of freedom of one element (a cell, or the two cells of a face) follow from the
 * unknowns of a reduced system: u_local = T x[indices] + g. T is a permutation but for constrained (hanging)
 * dofs.
 */
struct CondensedIndices
{
  std::vector<unsigned int> indices;      ///< unknowns, ascending, each once
  std::vector<unsigned int> row_start{0}; ///< row i of T: entries [row_start[i], row_start[i+1])
  std::vector<std::pair<unsigned int, double>> entries; ///< (position in indices, weight)
  std::vector<double> inhomogeneities;                  ///< g

  unsigned int n_local() const { return row_start.size() - 1; }

  /** u_local from the solution of the reduced system; @p homogeneous: without g. */
  void gather(const std::vector<double> &solution, double *local, bool homogeneous = false) const;

  /** residual += T^T local. */
  void scatter(const double *local, std::vector<double> &residual) const;
};

/**
 * Numbers the degrees of freedom that take part in an unfitted discretisation: those of the active cells, and
 * the masters of their constrained ones, iterated to closure (design section 2; FE_Nothing is avoided because
 * of spurious constraints at hanging nodes). Constrained and inactive dofs get no number.
 */
template <int dim>
class ActiveDofs
{
public:
  /**
   * @param dof_handler continuous element on the whole mesh
   * @param constraints hanging nodes and boundary values, closed
   * @param cell_is_active by active_cell_index; read for locally owned cells
   * @param first_number number of the first unknown (to stack several fields into one system)
   * Collective.
   */
  void reinit(const dealii::DoFHandler<dim> &dof_handler,
              const dealii::AffineConstraints<double> &constraints, const std::vector<bool> &cell_is_active,
              unsigned int first_number = 0);

  /** Number of unknowns on all ranks. */
  unsigned int size() const { return n_unknowns; }

  /** One past the last number: first_number + size(). */
  unsigned int end() const { return first + n_unknowns; }

  /** Is this locally relevant dof active (numbered or constrained to numbered ones)? */
  bool is_active(dealii::types::global_dof_index dof) const { return active(dof) > 0.; }

  /** Appends local dofs to an element; call finish() once all fields of the element are appended. */
  void append(const std::vector<dealii::types::global_dof_index> &dofs, CondensedIndices &element) const;

  /** Sorts the unknowns of an element and merges those that occur more than once. */
  static void finish(CondensedIndices &element);

  /** Number of a locally relevant dof, or -1. */
  int number(dealii::types::global_dof_index dof) const { return static_cast<int>(numbers(dof)); }

private:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;
  const dealii::AffineConstraints<double> *constraints = nullptr;
  Vector active;  ///< > 0 where active
  Vector numbers; ///< number or -1 (a double holds it exactly)
  unsigned int first = 0;
  unsigned int n_unknowns = 0;
};
} // namespace Gemmule
