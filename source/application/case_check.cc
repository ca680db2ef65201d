// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/application/case_check.h>
#include <gemmule/application/vesicle_problem.h>
#include <gemmule/output/run_log.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <cmath>
#include <sstream>

namespace Gemmule
{
using namespace dealii;

namespace
{
  /** The most memory that the processes had until now, in bytes. Collective. */
  double peak_memory(const MPI_Comm communicator)
  {
    constexpr double kilobyte = 1024.;
    Utilities::System::MemoryStats memory;
    Utilities::System::get_memory_stats(memory);
    return Utilities::MPI::sum(kilobyte * memory.VmHWM, communicator);
  }

  std::string in_words(const double bytes)
  {
    return bytes < 1e9 ? rounded(std::ceil(1e-6 * bytes)) + " MB"
                       : rounded(0.1 * std::ceil(1e-8 * bytes)) + " GB";
  }

  /** How the memory of a solver grows with the number of unknowns: this power (doc/performance.md). */
  double growth(const LinearSolver::Report &solver, const unsigned int dimension)
  {
    return solver.iterations > 0 ? 1. : dimension == 2 ? 1.1 : 1.5;
  }
} // namespace

template <int dim>
std::vector<std::string> warnings_before_start(const CoupledSystem<dim> &system)
{
  std::vector<std::string> warnings = system.initial_warnings();
  if (system.get_surface() == nullptr)
    return warnings;
  if (const auto warning = system.get_model().ill_posedness_warning())
    warnings.push_back(*warning);
  // A 10-90 % width of a phase boundary is 6.2 Cahn numbers.
  constexpr double cahn_numbers_per_cell = 3.2;
  const AllParameters &parameters = system.get_parameters();
  const double size = parameters.domain.cell_size(parameters.mesh.phase_boundary_level),
               cahn_number = parameters.membrane.cahn_number;
  if (size > cahn_numbers_per_cell * cahn_number && parameters.mesh.cells_per_phase_boundary == 0.)
    warnings.push_back(
        "the cells of 'Mesh/Phase boundary level' have edges of " + rounded(size) + ", " +
        rounded(size / cahn_number) + " times 'Membrane/Cahn number' = " + rounded(cahn_number) +
        ": about three times is the most that resolves phase boundaries. Raise the level, or set "
        "'Mesh/Cells per phase boundary' and 'Mesh/Finest level'.");
  return warnings;
}

std::string describe(const LinearSolver::Report &solver, const MPI_Comm communicator)
{
  return solver.method + " (" + in_words(Utilities::MPI::sum(solver.memory, communicator)) + ")";
}

template <int dim>
CaseCheck check_case(const AllParameters &parameters, const MPI_Comm communicator)
{
  if (dim == 3)
    VesicleProblem<dim>(parameters, communicator, "", false); // says what there is not in 3D
  const double before = peak_memory(communicator);
  CoupledSystem<dim> system(parameters, communicator);
  system.initialise();

  const auto solver = system.get_flow().linear_solver_report();
  const double all = peak_memory(communicator), of_solver = Utilities::MPI::sum(solver.memory, communicator);
  const double cells = system.mesh().n_global_active_cells(), most = parameters.mesh.largest_number_of_cells;
  const double of_mesh = std::max(all - before - of_solver, 0.);
  std::ostringstream size;
  size << cells << " cells, " << system.get_flow().n_unknowns()
       << " unknowns of the flow, which is solved by " << describe(solver, communicator) << "; "
       << in_words(all) << " of memory in all. With "
       << "'Mesh/Largest number of cells' = " << parameters.mesh.largest_number_of_cells
       << " it would be about "
       << in_words(before + of_mesh * most / cells + of_solver * std::pow(most / cells, growth(solver, dim)))
       << ".";
  return {warnings_before_start(system), size.str()};
}

template std::vector<std::string> warnings_before_start<2>(const CoupledSystem<2> &);
template std::vector<std::string> warnings_before_start<3>(const CoupledSystem<3> &);
template CaseCheck check_case<2>(const AllParameters &, MPI_Comm);
template CaseCheck check_case<3>(const AllParameters &, MPI_Comm);
} // namespace Gemmule
