#include <gemmule/application/vesicle_problem.h>
#include <gemmule/parameters/errors.h>

namespace Gemmule
{
template <int dim>
VesicleProblem<dim>::VesicleProblem(const AllParameters &parameters, MPI_Comm communicator,
                                    const std::string &, bool)
{
  check_case<dim>(parameters, communicator);
}

template <int dim>
int VesicleProblem<dim>::run()
{
  throw SimulationError("the time loop is not available yet.");
}

template <int dim>
void check_case(const AllParameters &, MPI_Comm)
{
  if (dim == 3)
    throw UserError("Dimension = 3 is not available yet. Set Dimension = 2.");
}

template class VesicleProblem<2>;
template class VesicleProblem<3>;
template void check_case<2>(const AllParameters &, MPI_Comm);
template void check_case<3>(const AllParameters &, MPI_Comm);
} // namespace Gemmule
