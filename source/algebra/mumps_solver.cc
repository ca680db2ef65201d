// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/mumps_solver.h>
#include <gemmule/base/arrival.h>
#include <gemmule/base/exceptions.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>

#include <dmumps_c.h>
#include <exception>

namespace Gemmule
{
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

  int &icntl(const int i) { return mumps.icntl[i - 1]; }
  int infog(const int i) const { return mumps.infog[i - 1]; }

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
}

MumpsSolver::~MumpsSolver()
{
  // On the way out of a failure that need not be one of all processes: MUMPS would wait for the others for
  // ever, and nobody would learn of the failure. What it has allocated ends with the process.
  if (std::uncaught_exceptions() > 0 && !all_processes_arrive(instance->communicator))
    return;
  instance->run(job_terminate);
}

void MumpsSolver::analyse(const unsigned int n, const std::vector<unsigned int> &rows,
                          const std::vector<unsigned int> &columns)
{
  AssertDimension(rows.size(), columns.size());
  auto &m = instance->mumps;
  instance->rows.resize(rows.size());
  instance->columns.resize(rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k)
  {
    instance->rows[k] = rows[k] + 1;
    instance->columns[k] = columns[k] + 1;
  }
  m.n = n;
  m.nnz_loc = rows.size();
  m.irn_loc = instance->rows.data();
  m.jcn_loc = instance->columns.data();
  instance->run(job_analyse);
  instance->check("analysis");
}

void MumpsSolver::factorise(const std::vector<double> &values)
{
  AssertDimension(values.size(), instance->rows.size());
  instance->values = values;
  instance->mumps.a_loc = instance->values.data();
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

void MumpsSolver::solve(std::vector<double> &rhs, const unsigned int n_rhs)
{
  auto &m = instance->mumps;
  if (dealii::Utilities::MPI::this_mpi_process(instance->communicator) == 0)
    AssertDimension(rhs.size(), static_cast<std::size_t>(m.n) * n_rhs);
  m.rhs = rhs.data();
  m.nrhs = n_rhs;
  m.lrhs = m.n;
  instance->run(job_solve);
  instance->check("solution");
}
} // namespace Gemmule
