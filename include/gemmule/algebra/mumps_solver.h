// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <memory>
#include <mpi.h>
#include <vector>

namespace Gemmule
{
/**
 * Sparse direct solver MUMPS with distributed input: each rank gives the entries it has (entries given more
 * than once, on one rank or several, are added). Approximate minimum degree ordering, which the design
 * measured as the fastest.
 */
class MumpsSolver
{
public:
  /** @param symmetric general symmetric (LDL^T): give one triangle only. */
  MumpsSolver(MPI_Comm communicator, bool symmetric);
  ~MumpsSolver();
  MumpsSolver(const MumpsSolver &) = delete;
  MumpsSolver &operator=(const MumpsSolver &) = delete;

  /** Sets the positions of the local entries (zero-based) and does the symbolic factorisation. Collective. */
  void analyse(unsigned int n, const std::vector<unsigned int> &rows,
               const std::vector<unsigned int> &columns);

  /** Numerical factorisation of the values at the analysed positions. Throws SimulationError. Collective. */
  void factorise(const std::vector<double> &values);

  /** Solves for @p n_rhs right-hand sides, stored one after the other on rank 0; the result is on rank 0.
   * Collective. */
  void solve(std::vector<double> &rhs, unsigned int n_rhs);

private:
  struct Instance;
  std::unique_ptr<Instance> instance;
};
} // namespace Gemmule
