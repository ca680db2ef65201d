// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/block_numbering.h>
#include <gemmule/algebra/condensed_indices.h>
#include <gemmule/algebra/linear_solver.h>
#include <gemmule/algebra/subassembled_matrix.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <memory>
#include <mpi.h>
#include <vector>

namespace Gemmule
{
/**
 * A sparse linear system in a reduced numbering, put together element by element: cells, pairs of cells at a
 * face, or whatever else couples unknowns. Vectors are distributed: the owned unknowns, and as ghosts those
 * of other ranks that occur in elements of this one.
 *
 * The pattern, and what a solver derives from it, is kept as long as the elements' unknowns do not change.
 *
 * Use: begin(); add_element() for all elements; finish_elements(); then any number of times: zero_matrix(),
 * add_matrix(), factorise(), solve().
 */
class LinearSystem
{
public:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

  /**
   * @param symmetric of the matrix only one triangle is stored
   * @param solver nullptr: the direct solver MUMPS
   */
  LinearSystem(MPI_Comm communicator, bool symmetric, std::unique_ptr<LinearSolver> solver = nullptr);

  void begin(const BlockNumbering &numbering);
  /** @param element with unknowns of the numbering of begin(), sorted @return its number, from zero on each
   * rank */
  unsigned int add_element(CondensedIndices &&element);
  /** Builds the sparsity pattern, or keeps the old one where it is still right. Collective. */
  void finish_elements();

  const BlockNumbering &numbering() const { return blocks; }
  unsigned int n_elements() const { return n_used_elements; }
  /** The unknowns of an element, in the numbering of the system. */
  const std::vector<dealii::types::global_dof_index> &element_unknowns(const unsigned int element) const
  {
    return unknowns[element];
  }
  const SubassembledMatrix &matrix() const { return sum; }

  /** Zero, with room for the unknowns of this rank's elements. */
  Vector make_vector() const { return Vector(partitioner); }
  /** Makes @p vector such a one. (An assignment would keep its ghosts where the owned ranges are the same.)
   */
  void reinit(Vector &vector) const { vector.reinit(partitioner); }

  void zero_matrix() { sum.set_zero(); }
  /** matrix += factor T^T local T. */
  void add_matrix(const unsigned int element, const dealii::FullMatrix<double> &local,
                  const double factor = 1.)
  {
    sum.add(elements[element], local, factor);
  }
  /** right_side -= factor T^T (local g), the contribution of inhomogeneous constraints. */
  void add_inhomogeneity(unsigned int element, const dealii::FullMatrix<double> &local, Vector &right_side,
                         double factor = 1.) const;
  /** right_side += T^T local. */
  void add_right_side(unsigned int element, const double *local, Vector &right_side) const;
  /** The local dofs of an element from a ghosted solution; @p homogeneous: without g. */
  void gather(unsigned int element, const Vector &solution, double *local, bool homogeneous = false) const;

  /**
   * Hands the matrix to the solver. Collective.
   * @param fixed see LinearSolver::prepare()
   * @throws SimulationError
   */
  void factorise(const dealii::types::global_dof_index fixed = dealii::numbers::invalid_dof_index)
  {
    solver->prepare(sum, blocks, fixed);
  }

  /**
   * @param right_sides sums of this rank's elements: completed in here
   * @param solutions on entry guesses; ghosted on exit. Collective.
   */
  void solve(std::vector<Vector> &right_sides, std::vector<Vector> &solutions);
  /** The same for one, without a guess. */
  Vector solve(Vector right_side);

  /** On the last factorise() and solve(). */
  LinearSolver::Report solver_report() const { return solver->report(); }

  /** A x; @p x ghosted. Complete on its owners. Collective. */
  Vector vmult(const Vector &x) const;

private:
  /** The unknowns of the elements as entries of vectors; finds new ghosts if @p changed. */
  void localise(bool changed);

  MPI_Comm communicator;
  BlockNumbering blocks;
  unsigned int n_used_elements = 0;
  std::vector<CondensedIndices> elements; ///< with local indices after finish_elements()
  std::vector<std::vector<dealii::types::global_dof_index>> unknowns; ///< of each element, in the numbering
  bool elements_changed = true;
  std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner;
  SubassembledMatrix sum;
  std::unique_ptr<LinearSolver> solver;
};
} // namespace Gemmule
