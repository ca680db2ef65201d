// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/rank_zero.h>

#include <deal.II/base/mpi.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <sstream>
#include <string>
#include <sys/resource.h>
#include <vector>

namespace Gemmule
{
/** A directory of its own for each test, the same on all ranks, removed at the end. */
class OutputTest : public ::testing::Test
{
protected:
  void SetUp() override
  {
    const auto *test = ::testing::UnitTest::GetInstance()->current_test_info();
    directory = "output-test-" + std::string(test->test_suite_name()) + "-" + test->name() + "-" +
                std::to_string(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
    on_rank_zero(MPI_COMM_WORLD,
                 [&]()
                 {
                   std::filesystem::remove_all(directory);
                   std::filesystem::create_directories(directory);
                 });
  }

  void TearDown() override
  {
    MPI_Barrier(MPI_COMM_WORLD); // others may still be looking at the files
    on_rank_zero(MPI_COMM_WORLD, [&]() { std::filesystem::remove_all(directory); });
  }

  std::string path(const std::string &name) const { return directory + "/" + name; }

  std::string content(const std::string &name) const
  {
    std::ifstream file(path(name));
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  std::vector<std::string> lines(const std::string &name) const
  {
    std::istringstream text(content(name));
    std::vector<std::string> list;
    for (std::string line; std::getline(text, line);)
      list.push_back(line);
    return list;
  }

  std::string directory;
};

class ParallelOutputTest : public OutputTest
{
};

/** Lets no file grow beyond a size while it lives, which is what a full disk does to a program. */
class FullDisk
{
public:
  explicit FullDisk(const rlim_t largest_size)
  {
    getrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit now = before;
    now.rlim_cur = largest_size;
    setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before); }

private:
  rlimit before;
};

inline std::string message_of(const std::function<void()> &action)
{
  try
  {
    action();
  }
  catch (const std::exception &error)
  {
    return error.what();
  }
  return "nothing thrown";
}
} // namespace Gemmule
