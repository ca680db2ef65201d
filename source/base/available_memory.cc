// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/available_memory.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>
#include <sys/resource.h>
#include <unistd.h>

namespace Gemmule
{
using namespace dealii;

namespace
{
  constexpr double unlimited = std::numeric_limits<double>::infinity();

  /** A file that holds one number; anything else ("max") or no file: unlimited. */
  double read_number(const std::string &path)
  {
    std::ifstream file(path);
    double value = 0.;
    return file >> value ? value : unlimited;
  }

  /** The value of "key 123" in a file of such lines, as it is there; otherwise @p otherwise. */
  double read_entry(const std::string &path, const std::string &key, const double otherwise)
  {
    std::ifstream file(path);
    std::string name;
    for (std::string line; std::getline(file, line);)
    {
      std::istringstream words(line);
      double value = 0.;
      if (words >> name >> value && name == key)
        return value;
    }
    return otherwise;
  }

  double free_on_machine(const std::string &root)
  {
    constexpr double kilobyte = 1024.;
    return kilobyte * read_entry(root + "/proc/meminfo", "MemAvailable:", unlimited);
  }

  /** What one control group leaves. Its pages of files count as used, but are given up when they are needed.
   */
  double left_by_group(const std::string &directory, const std::string &limit, const std::string &usage,
                       const std::string &files)
  {
    const double used = read_number(directory + "/" + usage);
    if (used == unlimited)
      return unlimited;
    const double of_files = read_entry(directory + "/memory.stat", files, 0.);
    return read_number(directory + "/" + limit) - std::max(used - of_files, 0.);
  }

  /** The least that the control group of this process and those around it leave. */
  double left_by_groups(const std::string &root)
  {
    double least = unlimited;
    std::ifstream groups(root + "/proc/self/cgroup");
    for (std::string line; std::getline(groups, line);)
    {
      const auto first = line.find(':'), second = line.find(':', first + 1);
      if (second == std::string::npos)
        continue;
      const std::string controllers = line.substr(first + 1, second - first - 1);
      const bool is_second_version = controllers.empty();
      if (!is_second_version && ("," + controllers + ",").find(",memory,") == std::string::npos)
        continue;
      for (std::string group = line.substr(second + 1);;)
      {
        const std::string top = root + "/sys/fs/cgroup" + (is_second_version ? "" : "/memory");
        least = std::min(least, is_second_version
                                    ? left_by_group(top + group, "memory.max", "memory.current", "file")
                                    : left_by_group(top + group, "memory.limit_in_bytes",
                                                    "memory.usage_in_bytes", "total_cache"));
        if (group.empty() || group == "/")
          break;
        group.erase(group.find_last_of('/'));
      }
    }
    return least;
  }
} // namespace

double memory_left_on_machine(const std::string &root)
{
  return std::max(0., std::min(free_on_machine(root), left_by_groups(root)));
}

double address_space_left()
{
  struct rlimit limit;
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return unlimited;
  double pages = 0.;
  std::ifstream("/proc/self/statm") >> pages;
  const double used = pages * static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::max(0., static_cast<double>(limit.rlim_cur) - used);
}

MemoryBudget scarcest_memory(const double touched, const double reserved, const MPI_Comm communicator)
{
  MPI_Comm machine;
  const int status = MPI_Comm_split_type(communicator, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine);
  AssertThrowMPI(status);
  MemoryBudget budget{Utilities::MPI::sum(touched, machine),
                      Utilities::MPI::min(memory_left_on_machine(), machine)};
  Utilities::MPI::free_communicator(machine);
  const MemoryBudget own{reserved, address_space_left()};
  // The part of what it needs that somebody has; without a need that part is infinite.
  const auto part = [](const MemoryBudget &of) { return of.needed > 0. ? of.left / of.needed : unlimited; };
  if (part(own) < part(budget))
    budget = own;

  struct
  {
    double part;
    int rank;
  } here{part(budget), static_cast<int>(Utilities::MPI::this_mpi_process(communicator))}, scarcest{};
  MPI_Allreduce(&here, &scarcest, 1, MPI_DOUBLE_INT, MPI_MINLOC, communicator);
  double numbers[2] = {budget.needed, budget.left};
  MPI_Bcast(numbers, 2, MPI_DOUBLE, scarcest.rank, communicator);
  return {numbers[0], numbers[1]};
}
} // namespace Gemmule
