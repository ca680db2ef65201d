// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/application/case_check.h>
#include <gemmule/application/command_line.h>
#include <gemmule/application/termination_signals.h>
#include <gemmule/application/vesicle_problem.h>
#include <gemmule/base/arrival.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/base/rank_zero.h>
#include <gemmule/output/disk_error.h>
#include <gemmule/output/output_directory.h>
#include <gemmule/parameters/all_parameters.h>
#include <gemmule/parameters/parameter_file.h>
#include <gemmule/parameters/text.h>

#include <deal.II/base/mpi.h>

#include <cerrno>
#include <functional>
#include <iostream>
#include <limits>
#include <new>
#include <sstream>
#include <string>
#include <vector>

namespace
{
using namespace Gemmule;

enum ExitCode
{
  finished = 0,
  user_error = 1,
  simulation_failed = 2
};

/** Runs @p action; on an exception sets @p message and returns the exit code that belongs to it. */
int guarded(const std::function<int()> &action, std::string &message)
{
  try
  {
    return action();
  }
  catch (const UserError &error)
  {
    message = error.what();
    return user_error;
  }
  catch (const SimulationError &error)
  {
    message = error.what();
  }
  catch (const std::bad_alloc &)
  {
    message = "out of memory. Use more processes on more machines, or a coarser mesh.";
  }
  catch (const std::exception &error)
  {
    message = std::string("internal error: ") + error.what();
  }
  catch (...)
  {
    message = "internal error of unknown kind.";
  }
  return simulation_failed;
}

/**
 * Carries out @p action on all processes and reports what went wrong, once.
 * @return the largest exit code of all processes
 */
int run_on_all(const std::function<int()> &action, const MPI_Comm communicator)
{
  std::string message;
  const int code = guarded(action, message);
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator);
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator);
  // One that has succeeded can wait for the others as long as it takes.
  const double patience = message.empty() ? std::numeric_limits<double>::infinity() : 10.;
  if (!all_processes_arrive(communicator, patience))
  {
    std::cerr << "gemmule: error: process " << rank << ": " << Parameters::printable(message) << std::endl;
    MPI_Abort(MPI_COMM_WORLD, code);
  }
  const unsigned int speaker = dealii::Utilities::MPI::min(message.empty() ? n_ranks : rank, communicator);
  if (rank == speaker)
    std::cerr << "gemmule: error: " << Parameters::printable(message) << std::endl;
  return dealii::Utilities::MPI::max(code, communicator);
}

/** Writes what was asked for. @throws SimulationError if standard output does not take it */
void say(const std::string &text)
{
  errno = 0;
  std::cout << text << std::flush;
  if (!std::cout)
    throw disk_error("cannot write to standard output", errno);
}

template <int dim>
int compute(const AllParameters &parameters, const CommandLine &command, CaseCheck &check)
{
  if (command.check)
  {
    check = check_case<dim>(parameters, MPI_COMM_WORLD);
    return finished;
  }
  if (!command.resume)
    on_rank_zero(MPI_COMM_WORLD, [&] { refuse_to_replace(command.case_file, parameters.output_directory); });
  VesicleProblem<dim> problem(parameters, MPI_COMM_WORLD, command.invocation, command.resume);
  return problem.run();
}
} // namespace

int main(int argc, char **argv)
{
  // PETSc, which deal.II may contain, would complain about options that it does not know.
  int n_arguments = 1;
  dealii::Utilities::MPI::MPI_InitFinalize mpi(n_arguments, argv, 1);
  TerminationSignals::keep_ignored();
  // Its own communicator: a failure may leave messages behind in that of the computation.
  const MPI_Comm communicator = dealii::Utilities::MPI::duplicate_communicator(MPI_COMM_WORLD);
  const bool speaks = dealii::Utilities::MPI::this_mpi_process(communicator) == 0;

  CommandLine command;
  AllParameters parameters;
  bool done = false;
  const auto prepare = [&]() -> int
  {
    command = CommandLine::parse(argc, argv);
    if (command.information.empty())
    {
      // What a pipe has given to one process, the others would wait for in vain.
      std::string text;
      if (!command.case_file.empty())
        on_rank_zero(communicator, [&] { text = Parameters::read_parameter_file(command.case_file); });
      text = dealii::Utilities::MPI::broadcast(communicator, text, 0);
      parameters.parse_text(command.case_file, text, command.overrides);
    }
    std::ostringstream text;
    if (command.information.empty() && command.print_parameters)
      parameters.print(text);
    if (speaks)
      say(command.information + text.str());
    done = command.print_parameters || !command.information.empty();
    return finished;
  };
  CaseCheck check;
  int code = run_on_all(prepare, communicator);
  if (code == finished && !done)
  {
    code = run_on_all(
        [&]
        {
          try
          {
            return parameters.dimension == 2 ? compute<2>(parameters, command, check)
                                             : compute<3>(parameters, command, check);
          }
          catch (const ParameterError &error)
          {
            throw parameters.located(error);
          }
        },
        communicator);
    if (code == finished && command.check)
      code = run_on_all(
          [&]() -> int
          {
            std::string text;
            for (const std::string &warning : check.warnings)
              text += "warning: " + warning + "\n";
            if (speaks)
              say(text + command.case_file + ": the parameters are valid.\n" + check.size + "\n");
            return finished;
          },
          communicator);
  }
  MPI_Comm to_free = communicator;
  dealii::Utilities::MPI::free_communicator(to_free);
  return code;
}
