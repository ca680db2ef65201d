// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/mumps_solver.h>
#include <gemmule/base/arrival.h>
#include <gemmule/base/exceptions.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi_noncontiguous_partitioner.h>

#include <dmumps_c.h>
#include <exception>
#include <limits>
#include <string>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // MUMPS' documentation counts its control parameters from one.
  constexpr int job_initialise = -1, job_terminate = -2, job_analyse = 1, job_factorise = 2, job_solve = 3;
  constexpr int error_workspace_too_small = -9, error_integer_workspace_too_small = -8;
} // namespace

struct MumpsSolver::Instance
{
  DMUMPS_STRUC_C mumps{};
  MPI_Comm communicator;
  std::vector<int> rows, columns;
  std::vector<double> values;
  unsigned int pattern_version = 0; ///< of the matrix that has been analysed; 0: none

  // MUMPS leaves each part of the solution where the last pivots of it were, and tells where that is.
  std::vector<int> right_side_rows, solution_rows;
  std::vector<double> right_side_values, solution_values;
  /** From there to the owners; found anew after each factorisation. nullptr on a single rank. */
  std::unique_ptr<Utilities::MPI::NoncontiguousPartitioner> to_owners;
  bool solution_is_located = false;

  int &icntl(const int i) { return mumps.icntl[i - 1]; }
  int infog(const int i) const { return mumps.infog[i - 1]; }

  void locate_solution(const IndexSet &owned);

  void run(const int job)
  {
    mumps.job = job;
    dmumps_c(&mumps);
  }

  void check(const std::string &stage) const
  {
    // MUMPS users' guide, "Error diagnostics"
    constexpr int singular = -10, allocation_failed = -13, memory_limit = -19;
    switch (infog(1))
    {
    case singular:
      throw SimulationError(
          "The direct solver MUMPS finds the matrix singular: the mesh does not resolve the membrane. Refine "
          "it with a higher 'Mesh/Membrane level'.");
    case allocation_failed:
    case memory_limit:
      throw SimulationError(
          "There is not enough memory for the direct solver MUMPS. Take fewer cells ('Mesh/Largest number of "
          "cells'), or more processes on more machines.");
    default:
      if (infog(1) < 0)
        throw SimulationError("The direct solver MUMPS failed in its " + stage + " (INFOG(1) = " +
                              std::to_string(infog(1)) + ", INFOG(2) = " + std::to_string(infog(2)) + ").");
    }
  }
};

MumpsSolver::MumpsSolver(const MPI_Comm communicator, const bool symmetric) : instance(new Instance)
{
  auto &m = instance->mumps;
  instance->communicator = communicator;
  m.par = 1;
  m.sym = symmetric ? 2 : 0;
  m.comm_fortran = static_cast<MUMPS_INT>(MPI_Comm_c2f(communicator));
  instance->run(job_initialise);
  instance->check("initialisation");
  for (const int output : {1, 2, 3, 4})
    instance->icntl(output) = 0; // silent: errors are reported through exceptions
  instance->icntl(7) = 0;        // approximate minimum degree
  instance->icntl(18) = 3;       // distributed entries, positions given by the user
  instance->icntl(14) = 60;      // percent of extra workspace, for delayed pivots of the indefinite matrix
  instance->icntl(20) = 10;      // right sides are distributed
  instance->icntl(21) = 1;       // and so are solutions
}

MumpsSolver::~MumpsSolver()
{
  // On the way out of a failure that need not be one of all processes: MUMPS would wait for the others for
  // ever, and nobody would learn of the failure. What it has allocated ends with the process.
  if (std::uncaught_exceptions() > 0 && !all_processes_arrive(instance->communicator))
    return;
  instance->run(job_terminate);
}

void MumpsSolver::prepare(const SubassembledMatrix &matrix, const BlockNumbering &numbering)
{
  if (instance->pattern_version != matrix.pattern_version())
  {
    analyse(matrix, numbering.size());
    instance->pattern_version = matrix.pattern_version();
  }
  factorise(matrix.entry_values());
}

void MumpsSolver::analyse(const SubassembledMatrix &matrix, const unsigned long long n)
{
  AssertThrow(n < static_cast<unsigned long long>(std::numeric_limits<int>::max()),
              ExcMessage("MUMPS counts unknowns in integers of 32 bits."));
  auto &m = instance->mumps;
  const auto &partitioner = *matrix.partitioner();
  const auto number = [&partitioner](const unsigned int local)
  { return static_cast<int>(partitioner.local_to_global(local)) + 1; };

  instance->rows.resize(matrix.n_entries());
  instance->columns.resize(matrix.n_entries());
  for (unsigned int row = 0; row < matrix.n_rows(); ++row)
  {
    const int row_number = number(row);
    for (std::size_t k = matrix.row_begin(row); k < matrix.row_begin(row + 1); ++k)
    {
      instance->rows[k] = row_number;
      instance->columns[k] = number(matrix.column(k));
    }
  }
  m.n = static_cast<int>(n);
  m.nnz_loc = matrix.n_entries();
  m.irn_loc = instance->rows.data();
  m.jcn_loc = instance->columns.data();

  instance->right_side_rows.resize(partitioner.locally_owned_size());
  for (unsigned int i = 0; i < instance->right_side_rows.size(); ++i)
    instance->right_side_rows[i] = number(i);
  instance->run(job_analyse);
  instance->check("analysis");
}

void MumpsSolver::factorise(const std::vector<double> &values)
{
  AssertDimension(values.size(), instance->rows.size());
  instance->values = values;
  instance->mumps.a_loc = instance->values.data();
  instance->solution_is_located = false;
  const int default_extra_workspace = 60, largest_extra_workspace = 2000;
  instance->icntl(14) = default_extra_workspace;
  while (true)
  {
    instance->run(job_factorise);
    const int status = instance->infog(1);
    const bool too_small = status == error_workspace_too_small || status == error_integer_workspace_too_small;
    if (!too_small || instance->icntl(14) > largest_extra_workspace)
      break;
    instance->icntl(14) *= 2;
  }
  instance->check("factorisation");
}

void MumpsSolver::Instance::locate_solution(const IndexSet &owned)
{
  to_owners.reset();
  if (Utilities::MPI::n_mpi_processes(communicator) > 1)
  {
    std::vector<types::global_dof_index> has, wants;
    for (const int row : solution_rows)
      has.push_back(row - 1);
    for (const auto index : owned)
      wants.push_back(index);
    to_owners = std::make_unique<Utilities::MPI::NoncontiguousPartitioner>(has, wants, communicator);
  }
  solution_is_located = true;
}

void MumpsSolver::solve(const std::vector<Vector> &right_sides, std::vector<Vector> &solutions)
{
  auto &m = instance->mumps;
  const unsigned int n_rhs = right_sides.size(), n_owned = instance->right_side_rows.size();
  instance->right_side_values.resize(static_cast<std::size_t>(n_rhs) * n_owned);
  for (unsigned int c = 0; c < n_rhs; ++c)
  {
    AssertDimension(right_sides[c].locally_owned_size(), n_owned);
    std::copy_n(right_sides[c].begin(), n_owned, instance->right_side_values.begin() + c * n_owned);
  }
  m.nrhs = n_rhs;
  m.nloc_rhs = m.lrhs_loc = n_owned;
  m.irhs_loc = instance->right_side_rows.data();
  m.rhs_loc = instance->right_side_values.data();

  const unsigned int n_here = m.info[23 - 1];
  instance->solution_rows.resize(n_here);
  instance->solution_values.resize(static_cast<std::size_t>(n_rhs) * n_here);
  m.lsol_loc = n_here;
  m.isol_loc = instance->solution_rows.data();
  m.sol_loc = instance->solution_values.data();
  instance->run(job_solve);
  instance->check("solution");

  const IndexSet &owned = right_sides[0].locally_owned_elements();
  if (!instance->solution_is_located)
    instance->locate_solution(owned);
  for (unsigned int c = 0; c < n_rhs; ++c)
  {
    const double *const here = instance->solution_values.data() + static_cast<std::size_t>(c) * n_here;
    if (instance->to_owners != nullptr)
      instance->to_owners->export_to_ghosted_array<double>(ArrayView<const double>(here, n_here),
                                                           ArrayView<double>(solutions[c].begin(), n_owned));
    else
      for (unsigned int i = 0; i < n_here; ++i)
        solutions[c].local_element(instance->solution_rows[i] - 1) = here[i];
  }
}
} // namespace Gemmule
