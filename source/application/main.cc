#include <gemmule/application/command_line.h>
#include <gemmule/application/vesicle_problem.h>
#include <gemmule/parameters/all_parameters.h>
#include <gemmule/parameters/errors.h>
#include <gemmule/parameters/text.h>

#include <deal.II/base/mpi.h>

#include <chrono>
#include <functional>
#include <iostream>
#include <new>
#include <thread>

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
 * Whether all processes come here within some seconds. A process that failed alone leaves the others waiting
 * in a communication that never completes.
 */
bool all_processes_arrive(const MPI_Comm communicator)
{
  MPI_Request request;
  MPI_Ibarrier(communicator, &request);
  const auto start = std::chrono::steady_clock::now();
  int arrived = 0;
  while (MPI_Test(&request, &arrived, MPI_STATUS_IGNORE), arrived == 0)
  {
    if (std::chrono::steady_clock::now() - start > std::chrono::seconds(10))
      return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
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
  if (!all_processes_arrive(communicator))
  {
    std::cerr << "gemmule: error: process " << rank << ": " << Parameters::printable(message) << std::endl;
    MPI_Abort(MPI_COMM_WORLD, code);
  }
  const unsigned int speaker = dealii::Utilities::MPI::min(message.empty() ? n_ranks : rank, communicator);
  if (rank == speaker)
    std::cerr << "gemmule: error: " << Parameters::printable(message) << std::endl;
  return dealii::Utilities::MPI::max(code, communicator);
}

template <int dim>
int compute(const AllParameters &parameters, const CommandLine &command)
{
  if (command.check)
  {
    check_case<dim>(parameters, MPI_COMM_WORLD);
    return finished;
  }
  VesicleProblem<dim> problem(parameters, MPI_COMM_WORLD, command.invocation, command.resume);
  return problem.run();
}
} // namespace

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
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
      parameters.parse(command.case_file, command.overrides);
    if (speaks)
      std::cout << command.information;
    if (command.information.empty() && command.print_parameters && speaks)
      parameters.print(std::cout);
    done = command.print_parameters || !command.information.empty();
    return finished;
  };
  int code = run_on_all(prepare, communicator);
  if (code == finished && !done)
  {
    code = run_on_all(
        [&]
        {
          try
          {
            return parameters.dimension == 2 ? compute<2>(parameters, command)
                                             : compute<3>(parameters, command);
          }
          catch (const ParameterError &error)
          {
            throw parameters.located(error);
          }
        },
        communicator);
    if (code == finished && command.check && speaks)
      std::cout << command.case_file << ": the parameters are valid." << std::endl;
  }
  std::cout.flush();
  MPI_Comm to_free = communicator;
  dealii::Utilities::MPI::free_communicator(to_free);
  return code;
}
