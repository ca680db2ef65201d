// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/mumps_solver.h>
#include <gemmule/base/arrival.h>
#include <gemmule/base/available_memory.h>
#include <gemmule/base/exceptions.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi_noncontiguous_partitioner.h>

#include <dmumps_c.h>
#include <exception>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>

namespace Gemmule
{
using namespace dealii;

namespace
{
  // MUMPS' documentation counts its control parameters from one.
  constexpr int job_initialise = -1, job_terminate = -2, job_analyse = 1, job_factorise = 2, job_solve = 3;
  constexpr int error_workspace_too_small = -9, error_integer_workspace_too_small = -8;
  constexpr int order_by_approximate_minimum_degree = 0, order_by_pord = 4;
  constexpr int default_extra_workspace = 60, largest_extra_workspace = 2000; // percent
  constexpr double megabyte = 1e6;
} // namespace

struct MumpsSolver::Instance
{
  DMUMPS_STRUC_C mumps{};
  MPI_Comm communicator;
  std::vector<int> rows, columns;
  std::vector<double> values;
  unsigned int fixed_here = numbers::invalid_unsigned_int; ///< an owned unknown that is to be zero
  double allocated = 0.;            ///< for the present factors on this process, in bytes
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

  static std::string how_to_save_memory()
  {
    return "Take fewer cells ('Mesh/Largest number of cells'), or more processes on more machines. For the "
           "flow the iterative solver needs less ('Flow discretisation/Solver').";
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
      throw SimulationError("There is not enough memory for the direct solver MUMPS. " +
                            how_to_save_memory());
    default:
      if (infog(1) < 0)
        throw SimulationError("The direct solver MUMPS failed in its " + stage + " (INFOG(1) = " +
                              std::to_string(infog(1)) + ", INFOG(2) = " + std::to_string(infog(2)) + ").");
    }
  }
};

MumpsSolver::MumpsSolver(const MPI_Comm communicator, const bool symmetric, const Ordering ordering)
    : instance(new Instance)
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
  instance->icntl(7) = ordering == Ordering::pord ? order_by_pord : order_by_approximate_minimum_degree;
  instance->icntl(18) = 3; // distributed entries, positions given by the user
  // For delayed pivots of the indefinite matrix.
  instance->icntl(14) = default_extra_workspace;
  instance->icntl(20) = 10; // right sides are distributed
  instance->icntl(21) = 1;  // and so are solutions
}

MumpsSolver::~MumpsSolver()
{
  // On the way out of a failure that need not be one of all processes: MUMPS would wait for the others for
  // ever, and nobody would learn of the failure. What it has allocated ends with the process.
  if (std::uncaught_exceptions() > 0 && !all_processes_arrive(instance->communicator))
    return;
  instance->run(job_terminate);
}

void MumpsSolver::prepare(const SubassembledMatrix &matrix, const BlockNumbering &numbering,
                          const Index fixed)
{
  if (instance->pattern_version != matrix.pattern_version())
  {
    analyse(matrix, numbering.size());
    instance->pattern_version = matrix.pattern_version();
  }
  copy_values(matrix, fixed);
  factorise();
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
  check_memory();
}

void MumpsSolver::check_memory() const
{
  // Estimates of the analysis, with the extra workspace, most of which is only reserved. Earlier factors go.
  constexpr double negligible = 1e8; // of any machine
  const double estimate = megabyte * instance->mumps.info[15 - 1];
  if (Utilities::MPI::max(estimate, instance->communicator) < negligible)
    return;
  const double reserved = estimate - instance->allocated;
  const double touched = estimate / (1. + 0.01 * default_extra_workspace) - instance->allocated;
  const MemoryBudget memory = scarcest_memory(touched, reserved, instance->communicator);
  if (memory.suffices())
    return;
  std::ostringstream message;
  message << std::setprecision(2) << "The direct solver MUMPS would need about " << 1e-9 * memory.needed
          << " GB of memory for " << instance->mumps.n << " unknowns, and only " << 1e-9 * memory.left
          << " GB are left. " << Instance::how_to_save_memory();
  throw SimulationError(message.str());
}

void MumpsSolver::copy_values(const SubassembledMatrix &matrix, const Index fixed)
{
  AssertDimension(matrix.n_entries(), instance->rows.size());
  auto &values = instance->values;
  values = matrix.entry_values();
  instance->mumps.a_loc = values.data();
  instance->fixed_here = numbers::invalid_unsigned_int;
  const auto &partitioner = *matrix.partitioner();
  if (fixed == numbers::invalid_dof_index ||
      !(partitioner.in_local_range(fixed) || partitioner.is_ghost_entry(fixed)))
    return;

  const unsigned int position = partitioner.global_to_local(fixed);
  for (unsigned int row = 0; row < matrix.n_rows(); ++row)
    for (std::size_t k = matrix.row_begin(row); k < matrix.row_begin(row + 1); ++k)
      if (row == position || matrix.column(k) == position)
        values[k] = row == matrix.column(k) && partitioner.in_local_range(fixed) ? 1. : 0.;
  if (partitioner.in_local_range(fixed))
    instance->fixed_here = position;
}

void MumpsSolver::factorise()
{
  instance->solution_is_located = false;
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
  instance->allocated = megabyte * instance->mumps.info[19 - 1];
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

LinearSolver::Report MumpsSolver::report() const
{
  Report report;
  report.method = "MUMPS";
  report.memory = megabyte * instance->mumps.info[22 - 1];
  return report;
}

void MumpsSolver::solve(const std::vector<Vector> &right_sides, std::vector<Vector> &solutions)
{
  auto &m = instance->mumps;
  const unsigned int n_rhs = right_sides.size(), n_owned = instance->right_side_rows.size();
  instance->right_side_values.resize(static_cast<std::size_t>(n_rhs) * n_owned);
  for (unsigned int c = 0; c < n_rhs; ++c)
  {
    AssertDimension(right_sides[c].locally_owned_size(), n_owned);
    double *const values = instance->right_side_values.data() + static_cast<std::size_t>(c) * n_owned;
    std::copy_n(right_sides[c].begin(), n_owned, values);
    if (instance->fixed_here != numbers::invalid_unsigned_int)
      values[instance->fixed_here] = 0.;
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
