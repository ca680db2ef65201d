// SPDX-License-Identifier: LGPL-2.1-or-later
// GoogleTest under MPI: every rank runs all tests, only rank 0 reports.
#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

int main(int argc, char **argv)
{
  ::testing::InitGoogleTest(&argc, argv);
  // PETSc, which deal.II may contain, would complain about options that it does not know.
  int n_arguments = 1;
  dealii::Utilities::MPI::MPI_InitFinalize mpi(n_arguments, argv, 1);
  const bool reports = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  if (::testing::GTEST_FLAG(list_tests))
    return reports ? RUN_ALL_TESTS() : 0;
  if (!reports)
    delete ::testing::UnitTest::GetInstance()->listeners().Release(
        ::testing::UnitTest::GetInstance()->listeners().default_result_printer());
  const int result = RUN_ALL_TESTS();
  return dealii::Utilities::MPI::max(result, MPI_COMM_WORLD);
}
