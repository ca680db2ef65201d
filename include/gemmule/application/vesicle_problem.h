#pragma once

#include <gemmule/parameters/all_parameters.h>

#include <mpi.h>
#include <string>

namespace Gemmule
{
/** Runs one case. */
template <int dim>
class VesicleProblem
{
public:
  VesicleProblem(const AllParameters &parameters, MPI_Comm communicator, const std::string &command_line,
                 bool resume);
  /** @return exit code of the program */
  int run();
};

/** Checks what needs more than the parameters themselves. @throws UserError */
template <int dim>
void check_case(const AllParameters &parameters, MPI_Comm communicator);
} // namespace Gemmule
