// SPDX-License-Identifier: LGPL-2.1-or-later
// The memory that is left, from the files in which Linux tells it.
#include <gemmule/base/available_memory.h>

#include <deal.II/base/mpi.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace Gemmule
{
namespace
{
  using namespace dealii;
  namespace fs = std::filesystem;

  /** A directory with files of a system that is made up. */
  class MadeUpSystem
  {
  public:
    MadeUpSystem() : root(fs::temp_directory_path() / ("gemmule_memory_" + std::to_string(getpid())))
    {
      fs::remove_all(root);
    }
    ~MadeUpSystem() { fs::remove_all(root); }
    MadeUpSystem(const MadeUpSystem &) = delete;
    MadeUpSystem &operator=(const MadeUpSystem &) = delete;

    void write(const std::string &name, const std::string &text) const
    {
      fs::create_directories((root / name).parent_path());
      std::ofstream(root / name) << text;
    }
    double left() const { return memory_left_on_machine(root.string()); }

  private:
    const fs::path root;
  };

  constexpr double kilobyte = 1024.;

  TEST(AvailableMemory, WithoutAnyFileItIsUnlimited)
  {
    EXPECT_TRUE(std::isinf(MadeUpSystem().left()));
  }

  TEST(AvailableMemory, TheMachineTellsWhatIsAvailable)
  {
    const MadeUpSystem system;
    system.write("proc/meminfo", "MemTotal:  1000 kB\nMemFree:  100 kB\nMemAvailable:    600 kB\n");
    EXPECT_EQ(system.left(), 600 * kilobyte);
  }

  TEST(AvailableMemory, AControlGroupOfTheSecondVersionLimitsIt)
  {
    const MadeUpSystem system;
    system.write("proc/meminfo", "MemAvailable: 600 kB\n");
    system.write("proc/self/cgroup", "0::/batch/job\n");
    system.write("sys/fs/cgroup/batch/job/memory.max", "200000\n");
    system.write("sys/fs/cgroup/batch/job/memory.current", "150000\n");
    system.write("sys/fs/cgroup/batch/job/memory.stat", "anon 120000\nfile 30000\n");
    EXPECT_EQ(system.left(), 80000.) << "pages of files are given up when memory is needed";
  }

  TEST(AvailableMemory, ALimitOfTheGroupAroundItHoldsAsWell)
  {
    const MadeUpSystem system;
    system.write("proc/self/cgroup", "0::/batch/job\n");
    system.write("sys/fs/cgroup/batch/job/memory.max", "max\n");
    system.write("sys/fs/cgroup/batch/job/memory.current", "150000\n");
    system.write("sys/fs/cgroup/batch/memory.max", "170000\n");
    system.write("sys/fs/cgroup/batch/memory.current", "160000\n");
    EXPECT_EQ(system.left(), 10000.);
  }

  TEST(AvailableMemory, AControlGroupOfTheFirstVersionLimitsIt)
  {
    const MadeUpSystem system;
    system.write("proc/self/cgroup", "5:devices:/\n4:cpu,memory:/box\n0::/\n");
    system.write("sys/fs/cgroup/memory/box/memory.limit_in_bytes", "5000\n");
    system.write("sys/fs/cgroup/memory/box/memory.usage_in_bytes", "4000\n");
    EXPECT_EQ(system.left(), 1000.);
  }

  TEST(AvailableMemory, AGroupThatIsUsedUpLeavesNothing)
  {
    const MadeUpSystem system;
    system.write("proc/self/cgroup", "0::/\n");
    system.write("sys/fs/cgroup/memory.max", "1000\n");
    system.write("sys/fs/cgroup/memory.current", "4000\n");
    EXPECT_EQ(system.left(), 0.);
  }

  TEST(ParallelAvailableMemory, ProcessesOnOneMachineShareIt)
  {
    const unsigned int n = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD),
                       rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
    const MemoryBudget budget = scarcest_memory(1e6 * (rank + 1.), 0., MPI_COMM_WORLD);
    EXPECT_EQ(budget.needed, 1e6 * n * (n + 1) / 2.);
    EXPECT_TRUE(budget.suffices());
    EXPECT_GT(budget.left, budget.needed);
    EXPECT_FALSE(scarcest_memory(1e18, 0., MPI_COMM_WORLD).suffices());
  }

  TEST(ParallelAvailableMemory, NobodyLacksWhatHeDoesNotNeed)
  {
    EXPECT_TRUE(scarcest_memory(0., 0., MPI_COMM_WORLD).suffices());
    EXPECT_TRUE(scarcest_memory(-1e9, -1e9, MPI_COMM_WORLD).suffices()) << "what will be given back";
  }
} // namespace
} // namespace Gemmule
