// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/active_dofs.h>
#include <gemmule/algebra/mumps_solver.h>

#include <deal.II/lac/full_matrix.h>

#include <mpi.h>
#include <vector>

namespace Gemmule
{
/**
 * A sparse linear system put together element by element in reduced numbering, and solved by a parallel
 * sparse direct factorisation.
 *
 * Every rank holds the contributions of its own elements only; MUMPS adds them up across ranks, so that
 * assembly needs no communication. Right-hand sides and solutions are complete on every rank (n numbers: fine
 * up to the sizes that a direct solver handles). Sparsity and symbolic factorisation are kept as long as the
 * elements' unknowns do not change.
 *
 * Use: begin(n); add_element() for all elements; finish_elements(); then any number of times: zero_matrix(),
 * add_matrix(), factorise(), solve().
 */
class ElementSystem
{
public:
  /** @param symmetric only the upper triangle is stored; LDL^T instead of LU. */
  ElementSystem(MPI_Comm communicator, bool symmetric);

  void begin(unsigned int n_unknowns);
  /** @return the element's number, counted from zero on each rank */
  unsigned int add_element(CondensedIndices &&element);
  /** Builds the sparsity pattern, or keeps the old one where it is still right. Collective. */
  void finish_elements();

  unsigned int n_unknowns() const { return n; }
  unsigned int n_elements() const { return n_used_elements; }
  const CondensedIndices &element(unsigned int e) const { return elements[e]; }

  void zero_matrix();
  /** matrix += T^T local T. For a symmetric system only the upper triangle of the reduced matrix is kept. */
  void add_matrix(unsigned int element, const dealii::FullMatrix<double> &local);
  /** rhs -= T^T (local g), the contribution of inhomogeneous constraints. */
  void add_inhomogeneity(unsigned int element, const dealii::FullMatrix<double> &local,
                         std::vector<double> &rhs) const;
  /** rhs += T^T local. */
  void add_rhs(unsigned int element, const double *local, std::vector<double> &rhs) const
  {
    elements[element].scatter(local, rhs);
  }

  /** Numerical (and, after a change of the pattern, symbolic) factorisation. Throws SimulationError.
   * Collective. */
  void factorise();

  /**
   * Solves in place. On entry each rank's own contributions to the right-hand side (length n), on exit the
   * solution, the same on all ranks. Collective.
   */
  void solve(std::vector<double> &rhs);
  /** The same for several right-hand sides with one pass through the factors. */
  void solve(std::vector<std::vector<double>> &rhs);

  /** y = A x with this rank's part of the matrix (sum over ranks for the product): for residuals in tests. */
  std::vector<double> apply_local_part(const std::vector<double> &x) const;

private:
  MPI_Comm communicator;
  bool symmetric;
  unsigned int n = 0;
  unsigned int n_used_elements = 0;
  std::vector<CondensedIndices> elements;
  bool elements_changed = true;
  bool pattern_changed = true;
  std::vector<std::size_t> row_start;
  std::vector<unsigned int> columns;
  std::vector<double> values;
  MumpsSolver solver;
  dealii::FullMatrix<double> condensed;
};
} // namespace Gemmule
