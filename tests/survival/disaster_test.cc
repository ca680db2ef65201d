// SPDX-License-Identifier: LGPL-2.1-or-later
// What no program can prevent: kills, full disks, damaged files.
#include <random>
#include <sys/mount.h>

#include "survival_fixture.h"

using namespace Gemmule::Testing;

class Disaster : public Survival
{
protected:
  static void flip_a_byte(const std::string &path)
  {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    const auto middle = static_cast<std::streamoff>(std::filesystem::file_size(path) / 2);
    file.seekg(middle);
    const int byte = file.get();
    file.seekp(middle);
    file.put(static_cast<char>(byte ^ 4));
  }

  /** Checkpoints that a kill has left, in order. */
  std::vector<std::string> incomplete_checkpoints() const
  {
    std::vector<std::string> found;
    std::error_code error;
    for (const auto &entry : std::filesystem::directory_iterator(results() + "/checkpoint", error))
      if (!std::filesystem::exists(entry.path() / "metadata.txt"))
        found.push_back(entry.path().string());
    std::sort(found.begin(), found.end());
    return found;
  }

  /** A run with a checkpoint after each step that has stopped somewhere in its second half. */
  void make_interrupted_run()
  {
    RunningProgram program(directory, run("--set 'Checkpoint/Steps between checkpoints=1'"));
    ASSERT_TRUE(program.wait_for(
        [&]
        {
          return n_rows(results()) > n_rows(reference()) / 2 &&
                 std::filesystem::exists(results() + "/solution-00002.h5");
        }));
    program.send(SIGTERM);
    ASSERT_EQ(program.wait(), 3);
    ASSERT_EQ(complete_checkpoints().size(), 2u);
  }
};

// Kills the run at random moments, every second time while a checkpoint is being written, and resumes it each
// time. The environment variable GEMMULE_KILLS says how often (default: 4), GEMMULE_KILL_SEED varies the
// moments.
TEST_F(Disaster, KilledAtRandomMomentsTheRunStillGivesTheSameResults)
{
  const char *const kills_text = std::getenv("GEMMULE_KILLS");
  const char *const seed_text = std::getenv("GEMMULE_KILL_SEED");
  const unsigned int n_wanted = kills_text != nullptr ? std::stoul(kills_text) : 4;
  std::mt19937 random(seed_text != nullptr ? std::stoul(seed_text) : 1);
  // From before the run has begun or resumed to several steps later.
  std::uniform_real_distribution<double> delay(0., 0.25 * reference_seconds);
  std::uniform_int_distribution<unsigned int> checkpoints_ahead(0, 3);
  const std::string options = "--set 'Checkpoint/Steps between checkpoints=1' ";

  unsigned int n_kills = 0, n_incomplete = 0, n_before_first = 0, n_runs_finished = 0;
  while (n_kills < n_wanted)
  {
    const bool can_resume = !complete_checkpoints().empty();
    const auto earlier = incomplete_checkpoints();
    RunningProgram program(directory, run(options + (can_resume ? "--resume" : "")));
    if (n_kills % 2 == 0)
      std::this_thread::sleep_for(std::chrono::duration<double>(delay(random)));
    else
    {
      // A directory without metadata.txt that is not the one that the last kill has left.
      const auto path_of = [&](const unsigned int number)
      {
        char name[32];
        std::snprintf(name, sizeof(name), "/checkpoint/%05u", number);
        return results() + name;
      };
      unsigned int next = 1;
      std::error_code error;
      for (const auto &entry : std::filesystem::directory_iterator(results() + "/checkpoint", error))
        next = std::max<unsigned int>(next, 1 + std::stoul(entry.path().filename().string()));
      next += checkpoints_ahead(random);
      program.wait_for([&] { return std::filesystem::exists(path_of(next)); });
      // Somewhere between its first file and its last.
      std::this_thread::sleep_for(std::chrono::microseconds(random() % 3000));
    }
    program.send(SIGKILL);
    const int code = program.wait();
    if (code == 0)
    {
      // It was faster. Once more from the start, so that the kills come at other moments.
      ++n_runs_finished;
      Comparison().results(reference(), results());
      std::filesystem::remove_all(results());
      continue;
    }
    ASSERT_EQ(code, 128 + SIGKILL) << directory.read(".stderr");
    ++n_kills;
    if (complete_checkpoints().empty())
      ++n_before_first;
    const auto incomplete = incomplete_checkpoints();
    n_incomplete += !std::includes(earlier.begin(), earlier.end(), incomplete.begin(), incomplete.end());
  }
  resume_to_the_end(options);
  Comparison().results(reference(), results());
  EXPECT_GE(complete_checkpoints().size(), 2u);
  std::cout << n_kills << " kills: " << n_before_first << " before the first checkpoint, " << n_incomplete
            << " left an incomplete checkpoint; " << n_runs_finished
            << " runs were finished and started again\n";
  EXPECT_GT(n_incomplete, 0u) << "no kill came while a checkpoint was written";
}

TEST_F(Disaster, DamagedCheckpointsAreNoticedAndTheOneBeforeIsTaken)
{
  make_interrupted_run();
  const std::string newest = complete_checkpoints().back();
  flip_a_byte(newest + "/state.h5");
  resume_to_the_end();
  EXPECT_NE(log().find("warning: run/checkpoint/" + std::filesystem::path(newest).filename().string() +
                       " cannot be used: state.h5 is damaged"),
            std::string::npos)
      << log();
  EXPECT_EQ(log().find("is missing"), std::string::npos) << log();
  Comparison().results(reference(), results());
}

TEST_F(Disaster, TruncatedCheckpointsAreNoticedAndTheOneBeforeIsTaken)
{
  make_interrupted_run();
  const std::string newest = complete_checkpoints().back();
  std::filesystem::resize_file(newest + "/state.h5", std::filesystem::file_size(newest + "/state.h5") / 2);
  // Nor do the results count on having stayed as they were.
  std::filesystem::resize_file(results() + "/interface.h5", 1000);
  resume_to_the_end();
  EXPECT_NE(log().find("state.h5 is damaged"), std::string::npos) << log();
  Comparison().results(reference(), results());
}

TEST_F(Disaster, WithoutAnyUsableCheckpointItSaysWhy)
{
  make_interrupted_run();
  for (const std::string &path : complete_checkpoints())
    flip_a_byte(path + "/state.h5");
  const Result result = run_gemmule(directory, run("--resume"));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("there is no usable checkpoint"), std::string::npos) << result.err;
  for (const std::string &path : complete_checkpoints())
    EXPECT_NE(result.err.find(std::filesystem::path(path).filename().string() + " cannot be used"),
              std::string::npos)
        << result.err;
}

TEST_F(Disaster, MissingAndDamagedResultsAreReportedAndCostNoOthers)
{
  make_interrupted_run();
  std::filesystem::remove(results() + "/solution-00000.h5");
  std::filesystem::resize_file(results() + "/solution-00001.h5", 1000);
  const Result result = run_gemmule(directory, run("--resume"));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(log().find("warning: solution.xdmf has 1 of the 3 "), std::string::npos) << log();
  EXPECT_FALSE(std::filesystem::exists(results() + "/solution-00000.h5"));
  EXPECT_EQ(std::filesystem::file_size(results() + "/solution-00001.h5"), 1000u);
  auto others = field_files(reference());
  others.erase("solution-00000.h5");
  others.erase("solution-00001.h5");
  for (const std::string &name : others)
    Comparison().fields(reference() + "/" + name, results() + "/" + name);
  Comparison().statistics(reference(), results());
  Comparison().membrane(reference() + "/interface.h5", results() + "/interface.h5");
}

// Who presses Ctrl-C before `gemmule | tee log` ends tee first.
TEST_F(Disaster, AReaderOfTheOutputThatHasGoneDoesNotEndTheRun)
{
  const Result result = run_gemmule(directory, run("| true"));
  ASSERT_EQ(result.exit_code, 0);
  EXPECT_NE(log().find("finished: t = 0.15"), std::string::npos) << log();
  Comparison().results(reference(), results());
}

TEST_F(Disaster, AnUnfinishedRunIsNotLostWhenResumeIsForgotten)
{
  make_interrupted_run();
  const std::size_t n_before = n_rows(results());
  ASSERT_EQ(run_gemmule(directory, run()).exit_code, 0);
  EXPECT_NE(log().find("warning: the directory held a run that had not finished"), std::string::npos)
      << log();
  Comparison().results(reference(), results());
  const std::string earlier = results() + "/earlier-run";
  EXPECT_EQ(n_rows(earlier), n_before);
  const Result resumed = run_gemmule(directory, run("--resume", "run/earlier-run"));
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  Comparison().results(reference(), earlier);

  // There is a place for each of them.
  const auto interrupted = run("--set 'Checkpoint/Wall time limit=1e-6'");
  ASSERT_EQ(run_gemmule(directory, interrupted).exit_code, 3);
  ASSERT_EQ(run_gemmule(directory, interrupted).exit_code, 3);
  EXPECT_NE(log().find("Its results are in run/earlier-run-2 now, and --resume --output run/earlier-run-2 "
                       "continues it."),
            std::string::npos)
      << log();
  EXPECT_EQ(n_rows(earlier), n_rows(reference()));
  ASSERT_EQ(run_gemmule(directory, run("--resume", "run/earlier-run-2")).exit_code, 0);
  Comparison().results(reference(), earlier + "-2");

  // What has finished is replaced.
  ASSERT_EQ(run_gemmule(directory, run("--resume")).exit_code, 0);
  ASSERT_EQ(run_gemmule(directory, run("--set 'End time=0.002'")).exit_code, 0);
  EXPECT_EQ(log().find("had not finished"), std::string::npos) << log();
  EXPECT_EQ(n_rows(earlier), n_rows(reference()));
}

// A limit on the size of files does to a program what a full disk does, and needs no permissions.
TEST_F(Disaster, NoRoomForACheckpoint)
{
  make_interrupted_run();
  const auto before = complete_checkpoints();
  // The log and statistics still fit.
  const rlim_t too_small = std::filesystem::file_size(before.back() + "/state.h5") / 2;
  const std::size_t n_before = n_rows(results());
  RunningProgram program(directory, run("--resume --set 'Output/Field output interval=0' "
                                        "--set 'Output/Interface output interval=0'"));
  ASSERT_TRUE(program.wait_for([&] { return n_rows(results()) > n_before; }));
  // From now on: MPI needs larger files to begin with.
  program.limit_files(too_small);
  program.send(SIGTERM);
  EXPECT_EQ(program.wait(), 2);
  const std::string message = directory.read(".stderr");
  EXPECT_NE(message.find("state.h5, for which"), std::string::npos) << message;
  EXPECT_NE(
      message.find("the file would be larger than files may be here. Raise the limit ('ulimit -f', or that "
                   "of the file system). Then go on with --resume.\n"),
      std::string::npos)
      << message;
  EXPECT_EQ(complete_checkpoints(), before);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(results() + "/checkpoint"),
                          std::filesystem::directory_iterator()),
            2)
      << "what was begun is removed";
  resume_to_the_end();
  Comparison().results(reference(), results());
}

TEST_F(Disaster, AFullDiskEndsTheRunAndMoreRoomContinuesIt)
{
  std::filesystem::create_directory(results());
  if (mount("tmpfs", results().c_str(), "tmpfs", 0, "size=1500k") != 0)
    GTEST_SKIP() << "mounting a small file system needs permissions that this user does not have";
  struct Unmount
  {
    ~Unmount() { umount2(path.c_str(), MNT_DETACH); }
    const std::string path;
  } unmount{results()};

  const std::string options = "--set 'Checkpoint/Steps between checkpoints=1' ";
  const Result full = run_gemmule(directory, run(options));
  EXPECT_EQ(full.exit_code, 2) << full.out << full.err;
  EXPECT_NE(full.err.find("the disk is full. Make room. Then go on with --resume."), std::string::npos)
      << full.err;
  ASSERT_GE(complete_checkpoints().size(), 1u);

  // Still full.
  const Result again = run_gemmule(directory, run(options + "--resume"));
  EXPECT_EQ(again.exit_code, 2) << again.err;
  EXPECT_NE(again.err.find("the disk is full. Make room. Then go on with --resume."), std::string::npos)
      << again.err;
  ASSERT_GE(complete_checkpoints().size(), 1u);

  ASSERT_EQ(mount("tmpfs", results().c_str(), "tmpfs", MS_REMOUNT, "size=100m"), 0);
  resume_to_the_end(options);
  Comparison().results(reference(), results());
}
