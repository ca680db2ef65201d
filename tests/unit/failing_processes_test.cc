// SPDX-License-Identifier: LGPL-2.1-or-later
// A failure of one process alone must not leave the others, or itself, waiting for ever.
#include <gemmule/algebra/mumps_solver.h>
#include <gemmule/base/arrival.h>
#include <gemmule/base/rank_zero.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>
#include <memory>
#include <new>

using namespace Gemmule;
using dealii::Utilities::MPI::n_mpi_processes;
using dealii::Utilities::MPI::this_mpi_process;

TEST(ParallelFailure, OutOfMemoryOnRankZeroIsOutOfMemoryEverywhere)
{
  EXPECT_THROW(on_rank_zero(MPI_COMM_WORLD, [] { throw std::bad_alloc(); }), std::bad_alloc);
}

TEST(ParallelFailure, ArrivalIsNoticedAndAbsenceToo)
{
  // Not to be used again: one process is waited for in vain.
  MPI_Comm communicator = dealii::Utilities::MPI::duplicate_communicator(MPI_COMM_WORLD);
  EXPECT_TRUE(all_processes_arrive(communicator));
  if (n_mpi_processes(MPI_COMM_WORLD) > 1 && this_mpi_process(MPI_COMM_WORLD) == 1)
  {
    EXPECT_FALSE(all_processes_arrive(communicator, 0.2));
  }
  MPI_Barrier(MPI_COMM_WORLD);
}

TEST(ParallelFailure, ASolverIsLeftBehindByOneProcessAlone)
{
  if (n_mpi_processes(MPI_COMM_WORLD) == 1)
    GTEST_SKIP() << "takes two processes";
  MPI_Comm communicator = dealii::Utilities::MPI::duplicate_communicator(MPI_COMM_WORLD);
  auto solver = std::make_unique<MumpsSolver>(communicator, true);
  // The other one is in a communication of its own when it fails. MUMPS would wait for it for ever.
  if (this_mpi_process(MPI_COMM_WORLD) == 1)
  {
    const auto fail = [&]
    {
      const auto local = std::move(solver);
      throw std::bad_alloc();
    };
    EXPECT_THROW(fail(), std::bad_alloc);
  }
  MPI_Barrier(MPI_COMM_WORLD);
  // Nothing can be done with the solver any more.
  static MumpsSolver *left_behind;
  left_behind = solver.release();
  EXPECT_EQ(left_behind == nullptr, this_mpi_process(MPI_COMM_WORLD) == 1);
}
