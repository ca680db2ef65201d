// SPDX-License-Identifier: LGPL-2.1-or-later
// What the output module writes as text is read back, as a user's script or a resumed run would.
#include "support/output_test.h"

#include <gemmule/base/exceptions.h>
#include <gemmule/output/output_directory.h>
#include <gemmule/output/run_log.h>
#include <gemmule/output/statistics.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <map>

using namespace Gemmule;

namespace
{
std::ptrdiff_t count(const char character, const std::string &text)
{
  return std::count(text.begin(), text.end(), character);
}

} // namespace

TEST_F(OutputTest, StatisticsHeaderIsTheContract)
{
  StatisticsWriter writer(directory, MPI_COMM_SELF);
  const std::string contract =
      "time,step,time_step_size,cells,flow_dofs,surface_dofs,centroid_x,centroid_y,area,arclength,mass_f,"
      "mass_total,energy_surface,energy_phase,energy_constraint,energy_bending,energy_total,"
      "dissipation_viscous,dissipation_phase,max_velocity,tension_min,tension_max,f_total_min,f_total_max,"
      "composition_min,composition_max,phase_boundaries,components,curvature_max,deformation,"
      "area_correction,linear_iterations,wall_time";
  ASSERT_EQ(lines("statistics.csv").size(), 1u);
  EXPECT_EQ(lines("statistics.csv")[0].substr(0, contract.size() + 1), contract + ",");
}

TEST_F(OutputTest, StatisticsRowsReproduceEveryDigit)
{
  StatisticsRow row;
  row.time = 0.1;
  row.step = 7;
  row.cells = 12345678901ul;
  row.centroid_x = -1. / 3.;
  row.wall_time = 1e-300;
  row.phase_boundaries = 4;
  row.time_error_composition = dealii::numbers::PI;
  StatisticsWriter writer(directory, MPI_COMM_SELF);
  writer.write(row);

  // The writer is still open: the row has to be on disk nevertheless.
  const std::vector<std::string> names = statistics_columns();
  ASSERT_EQ(lines("statistics.csv").size(), 2u);
  std::istringstream line(lines("statistics.csv")[1]);
  std::map<std::string, std::string> values;
  for (const std::string &name : names)
    ASSERT_TRUE(std::getline(line, values[name], ','));
  EXPECT_EQ(std::stod(values["time"]), row.time);
  EXPECT_EQ(values["step"], "7");
  EXPECT_EQ(values["cells"], "12345678901");
  EXPECT_EQ(std::stod(values["centroid_x"]), row.centroid_x);
  EXPECT_EQ(std::stod(values["wall_time"]), row.wall_time);
  EXPECT_EQ(values["phase_boundaries"], "4");
  EXPECT_EQ(std::stod(values["time_error_composition"]), row.time_error_composition);
}

TEST_F(OutputTest, StatisticsOfAResumedRunAreCutOff)
{
  {
    StatisticsWriter writer(directory, MPI_COMM_SELF);
    StatisticsRow row;
    for (row.step = 1; row.step <= 5; ++row.step)
    {
      row.time = 0.1 * row.step;
      writer.write(row);
    }
  }
  const std::vector<std::string> before = lines("statistics.csv");
  std::ofstream(path("statistics.csv"), std::ios::app) << "0.2,6,0.1"; // what a kill leaves

  StatisticsWriter resumed(directory, MPI_COMM_SELF, 0.1 * 3);
  EXPECT_EQ(lines("statistics.csv"), std::vector<std::string>(before.begin(), before.begin() + 4));
  StatisticsRow row;
  row.time = 0.35;
  resumed.write(row);
  EXPECT_EQ(lines("statistics.csv").size(), 5u);
  EXPECT_EQ(lines("statistics.csv").back().substr(0, 4), "0.34"); // 0.34999999999999998
}

TEST_F(OutputTest, StatisticsOfAnotherVersionAreNotMixed)
{
  std::ofstream(path("statistics.csv")) << "time,step\n0,0\n";
  EXPECT_THROW(StatisticsWriter(directory, MPI_COMM_SELF, 1.), UserError);
  EXPECT_EQ(lines("statistics.csv").size(), 2u);
  StatisticsWriter fresh(directory, MPI_COMM_SELF);
  EXPECT_EQ(lines("statistics.csv").size(), 1u);
}

TEST_F(ParallelOutputTest, StatisticsFailureReachesAllRanks)
{
  StatisticsWriter writer(directory, MPI_COMM_WORLD);
  const FullDisk full_disk(1000);
  const std::string message = message_of(
      [&]()
      {
        for (unsigned int i = 0; i < 100; ++i)
          writer.write(StatisticsRow());
      });
  EXPECT_EQ(message,
            "Cannot write to " + path("statistics.csv") +
                ": the file would be larger than files may be here. Raise the limit ('ulimit -f', or "
                "that of the file system).");
}

TEST_F(OutputTest, StatisticsThatCannotBeReadAreNotReplaced)
{
  // A folder cannot be read either, and by no user.
  std::filesystem::create_directory(path("statistics.csv"));
  const std::string message = message_of([&]() { StatisticsWriter(directory, MPI_COMM_SELF, 1.); });
  EXPECT_NE(message.find("statistics.csv"), std::string::npos) << message;
  EXPECT_TRUE(std::filesystem::is_directory(path("statistics.csv")));
}

TEST_F(OutputTest, ARowIsNotWrittenIntoAFileThatHasBeenRemoved)
{
  StatisticsWriter writer(directory, MPI_COMM_SELF);
  writer.write(StatisticsRow());
  std::filesystem::remove(path("statistics.csv"));
  const std::string message = message_of([&]() { writer.write(StatisticsRow()); });
  EXPECT_EQ(message, "Cannot write to " + path("statistics.csv") +
                         ": the file or its directory does not exist. Put it back if it has been moved.");
}

TEST_F(OutputTest, ALogThatHasBeenRemovedBeginsAgain)
{
  std::ostringstream console;
  RunLog log(directory, MPI_COMM_SELF, false, {console, false, []() { return 0.; }});
  log.info("first");
  std::filesystem::remove(path("log.txt"));
  log.info("second");
  EXPECT_EQ(content("log.txt"),
            "Gemmule goes on here: log.txt was removed while the run was at work.\nsecond\n");
  EXPECT_NO_THROW(log.check());
}

TEST_F(ParallelOutputTest, ALogThatLacksALineIsNoticedOnAllRanks)
{
  std::ostringstream console;
  RunLog log(directory, MPI_COMM_WORLD, false, {console, false, []() { return 0.; }});
  log.info("first");
  EXPECT_NO_THROW(log.check());
  {
    const FullDisk full_disk(10);
    log.info("a line that is too long");
  }
  const std::string message = message_of([&]() { log.check(); });
  EXPECT_NE(message.find(path("log.txt") + ": the file would be larger"), std::string::npos) << message;
  EXPECT_NO_THROW(log.check()) << "once is enough";
}

TEST_F(ParallelOutputTest, DirectoryIsCreatedAndAParameterFileWritten)
{
  const std::string results = path("deep/results");
  const OutputDirectory output(results, MPI_COMM_WORLD);
  output.write_parameters("set End time = 1\n");
  EXPECT_EQ(content("deep/results/parameters.prm"), "set End time = 1\n");
  EXPECT_EQ(output.file("log.txt"), results + "/log.txt");
}

TEST_F(ParallelOutputTest, DirectoryInUseIsRefusedOnAllRanks)
{
  const std::string results = path("results");
  {
    const OutputDirectory first(results, MPI_COMM_WORLD);
    for (const bool resume : {false, true})
    {
      EXPECT_THROW(OutputDirectory(results, MPI_COMM_WORLD, resume), UserError);
      const std::string message = message_of([&]() { OutputDirectory(results, MPI_COMM_WORLD, resume); });
      EXPECT_EQ(message.find("Another run of gemmule is writing to the output directory '" + results +
                             "' (process "),
                0u)
          << message;
      EXPECT_NE(message.find("--output"), std::string::npos) << message;
    }
    EXPECT_NO_THROW(OutputDirectory(path("others"), MPI_COMM_WORLD));
  }
  EXPECT_NO_THROW(OutputDirectory(results, MPI_COMM_WORLD));
}

TEST_F(OutputTest, LockOfADirectoryThatNobodyHasUsed)
{
  EXPECT_EQ(DirectoryLock::acquire_existing(directory), nullptr);
  EXPECT_FALSE(std::filesystem::exists(path(".lock"))) << "it must write nothing";
  auto lock = DirectoryLock::acquire(directory);
  EXPECT_THROW(DirectoryLock::acquire_existing(directory), UserError);
  lock.reset();
  EXPECT_NE(DirectoryLock::acquire_existing(directory), nullptr);
}

TEST_F(ParallelOutputTest, DirectoryThatCannotBeCreated)
{
  on_rank_zero(MPI_COMM_WORLD, [&]() { std::ofstream(path("file")) << "in the way"; });
  for (const std::string &impossible : std::vector<std::string>{path("file"), path("file/results")})
  {
    EXPECT_THROW(OutputDirectory(impossible, MPI_COMM_WORLD), UserError);
    const std::string message = message_of([&]() { OutputDirectory(impossible, MPI_COMM_WORLD); });
    EXPECT_NE(message.find(impossible), std::string::npos) << message;
    EXPECT_NE(message.find("--output"), std::string::npos) << message;
  }
}

TEST_F(OutputTest, DirectoryOnAFullDisk)
{
  const FullDisk full_disk(4);
  EXPECT_THROW(OutputDirectory(directory, MPI_COMM_SELF), SimulationError);
}

TEST_F(OutputTest, LogGoesToFileAndConsole)
{
  std::ostringstream console;
  {
    RunLog log(directory, MPI_COMM_SELF, false, {console, false, []() { return 0.; }});
    log.info("Reading case.prm");
    log.warn_once("negative tension", "the tension is negative");
    log.warn_once("negative tension", "the tension is negative again");
    log.warn("second");
  }
  EXPECT_EQ(console.str(), "Reading case.prm\nwarning: the tension is negative\nwarning: second\n");
  EXPECT_EQ(content("log.txt"), console.str());
  {
    RunLog resumed(directory, MPI_COMM_SELF, /*append =*/true, {console, false, []() { return 0.; }});
    resumed.info("Resumed");
  }
  EXPECT_EQ(lines("log.txt").size(), 4u);
}

TEST_F(OutputTest, ProgressIsOneLineOnATerminal)
{
  std::ostringstream console;
  double now = 0.;
  RunLog log(directory, MPI_COMM_SELF, false, {console, true, [&now]() { return now; }});
  log.progress(0., 2., 0, 0.1);
  now = 10.;
  log.progress(0.5, 2., 5, 0.1);
  EXPECT_EQ(count('\n', console.str()), 0);
  EXPECT_EQ(count('\r', console.str()), 2);
  EXPECT_NE(console.str().find(" 25 %"), std::string::npos) << console.str();
  EXPECT_NE(console.str().find("30 s left"), std::string::npos) << console.str();
  log.info("message");
  EXPECT_NE(console.str().find("left\nmessage\n"), std::string::npos) << console.str();
  EXPECT_EQ(content("log.txt"), "message\n");
}

TEST_F(OutputTest, ProgressIsRareElsewhere)
{
  std::ostringstream console;
  double now = 0.;
  RunLog log(directory, MPI_COMM_SELF, false, {console, false, [&now]() { return now; }});
  for (unsigned int step = 0; step <= 100; ++step, now += 0.5)
    log.progress(0.01 * step, 1., step, 0.01);
  // At 0, 10, 20, 30, 40 and 50 seconds, the last of which is the end.
  EXPECT_EQ(count('\n', console.str()), 6) << console.str();
  EXPECT_EQ(count('\r', console.str()), 0);
  EXPECT_NE(console.str().find("finished"), std::string::npos);
}

TEST(ProgressFormat, Durations)
{
  EXPECT_EQ(format_duration(0.4), "0 s");
  EXPECT_EQ(format_duration(59.4), "59 s");
  EXPECT_EQ(format_duration(59.6), "1 min 00 s");
  EXPECT_EQ(format_duration(185.), "3 min 05 s");
  EXPECT_EQ(format_duration(2. * 3600. + 7. * 60. + 5.), "2 h 07 min");
  EXPECT_EQ(format_duration(INFINITY), "?");
}

TEST(ProgressFormat, Line)
{
  EXPECT_EQ(format_progress(0.1234, 0.5, 42, 1.25e-3, 185.),
            " 24 %  time 0.1234 of 0.5, step 42, step size 1.25e-03, 3 min 05 s left");
  // Nearly finished is not finished.
  EXPECT_EQ(format_progress(0.9999, 1., 1, 0.1, 1.).substr(0, 5), " 99 %");
}
