// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/base/gather.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <new>
#include <numeric>
#include <sstream>
#include <stdexcept>

namespace Gemmule
{
using namespace dealii;

ByteGather::ByteGather(const std::size_t n_bytes, const MPI_Comm communicator,
                       const std::size_t most_bytes_at_once)
    : communicator(communicator), most_bytes_at_once(most_bytes_at_once),
      lengths(Utilities::MPI::n_mpi_processes(communicator))
{
  Assert(most_bytes_at_once > 0 && most_bytes_at_once <= longest_message,
         ExcMessage("MPI takes messages of at least one byte, and no longer ones."));
  const std::uint64_t own_length = n_bytes;
  MPI_Allgather(&own_length, 1, MPI_UINT64_T, lengths.data(), 1, MPI_UINT64_T, communicator);
  total = std::accumulate(lengths.begin(), lengths.end(), std::size_t(0));
}

void ByteGather::make_room(const std::function<void()> &allocate) const
{
  // So little is there, or nothing is: the ranks need not ask each other each time.
  if (fits_one_message())
    return allocate();
  bool has_room = true;
  try
  {
    allocate();
  }
  catch (const std::bad_alloc &)
  {
    has_room = false;
  }
  catch (const std::length_error &)
  {
    has_room = false;
  }
  if (Utilities::MPI::min(static_cast<int>(has_room), communicator) == 1)
    return;
  std::ostringstream message;
  message.precision(3);
  message << "What every process keeps of the membrane and the mesh takes "
          << static_cast<double>(total) / (1 << 30)
          << " GiB, more than there is room for. Choose a coarser mesh, or fewer processes on each machine.";
  throw SimulationError(message.str());
}

void ByteGather::gather(const void *const piece, void *const all) const
{
  if (fits_one_message())
  {
    std::vector<int> counts(lengths.begin(), lengths.end()), offsets(lengths.size(), 0);
    std::partial_sum(counts.begin(), counts.end() - 1, offsets.begin() + 1);
    MPI_Allgatherv(piece, counts[Utilities::MPI::this_mpi_process(communicator)], MPI_BYTE, all,
                   counts.data(), offsets.data(), MPI_BYTE, communicator);
    return;
  }
  // One rank after the other, straight to their places: places are numbers of type int as well.
  char *place = static_cast<char *>(all);
  for (unsigned int rank = 0; rank < lengths.size(); ++rank)
  {
    if (rank == Utilities::MPI::this_mpi_process(communicator))
      std::copy_n(static_cast<const char *>(piece), lengths[rank], place);
    for (std::uint64_t done = 0; done < lengths[rank]; done += most_bytes_at_once)
      MPI_Bcast(place + done,
                static_cast<int>(std::min<std::uint64_t>(most_bytes_at_once, lengths[rank] - done)), MPI_BYTE,
                static_cast<int>(rank), communicator);
    place += lengths[rank];
  }
}
} // namespace Gemmule
