// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/arrival.h>

#include <chrono>
#include <thread>

namespace Gemmule
{
bool all_processes_arrive(const MPI_Comm communicator, const double seconds)
{
  MPI_Request request;
  MPI_Ibarrier(communicator, &request);
  const auto start = std::chrono::steady_clock::now();
  int arrived = 0;
  while (MPI_Test(&request, &arrived, MPI_STATUS_IGNORE), arrived == 0)
  {
    if (std::chrono::steady_clock::now() - start > std::chrono::duration<double>(seconds))
      return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}
} // namespace Gemmule
