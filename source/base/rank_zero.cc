// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/base/rank_zero.h>

#include <new>
#include <string>

namespace Gemmule
{
namespace
{
  enum Outcome : int
  {
    success = 0,
    user_error = 1,
    simulation_error = 2,
    out_of_memory = 3,
    failed_on_disk = 4
  };
} // namespace

void on_rank_zero(const MPI_Comm &communicator, const std::function<void()> &action)
{
  int rank = 0;
  MPI_Comm_rank(communicator, &rank);

  std::string message;
  int report[2] = {success, 0}; // outcome, length of the message
  if (rank == 0)
  {
    try
    {
      action();
    }
    catch (const UserError &error)
    {
      report[0] = user_error;
      message = error.what();
    }
    catch (const DiskError &error)
    {
      report[0] = failed_on_disk;
      message = error.what();
    }
    catch (const std::bad_alloc &)
    {
      report[0] = out_of_memory;
    }
    catch (const std::exception &error)
    {
      report[0] = simulation_error;
      message = error.what();
    }
    report[1] = static_cast<int>(message.size());
  }

  MPI_Bcast(report, 2, MPI_INT, 0, communicator);
  if (report[0] == success)
    return;
  message.resize(report[1]);
  MPI_Bcast(message.data(), report[1], MPI_CHAR, 0, communicator);
  if (report[0] == user_error)
    throw UserError(message);
  if (report[0] == failed_on_disk)
    throw DiskError(message);
  if (report[0] == out_of_memory)
    throw std::bad_alloc();
  throw SimulationError(message);
}
} // namespace Gemmule
