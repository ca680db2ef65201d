// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/base/raise_together.h>

#include <deal.II/base/mpi.h>

namespace Gemmule
{
void raise_together(const std::string &parameter, const std::string &complaint, const MPI_Comm communicator)
{
  const unsigned int n_ranks = dealii::Utilities::MPI::n_mpi_processes(communicator);
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator);
  const unsigned int speaker = dealii::Utilities::MPI::min(complaint.empty() ? n_ranks : rank, communicator);
  if (speaker < n_ranks)
    throw ParameterError(parameter, dealii::Utilities::MPI::broadcast(communicator, complaint, speaker));
}
} // namespace Gemmule
