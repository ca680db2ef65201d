// SPDX-License-Identifier: LGPL-2.1-or-later
// What becomes of results that are in the output directory when a run begins: nothing is lost, and what a
// message advises works.
#include "survival_fixture.h"

using namespace Gemmule::Testing;

class EarlierRun : public Survival
{
protected:
  const std::string brief = "--set 'End time=0.002' ";

  void write(const std::string &name, const std::string &text) const { directory.write("run/" + name, text); }
  /** All files below the results, with what they hold. */
  std::map<std::string, std::string> everything() const
  {
    std::map<std::string, std::string> found;
    for (const auto &entry : std::filesystem::recursive_directory_iterator(results()))
      if (entry.is_regular_file())
        found[entry.path().string()] =
            directory.read(std::filesystem::relative(entry.path(), directory.path).string());
    return found;
  }
  void expect_moved_to(const std::string &folder, const std::size_t n_rows_before,
                       const std::string &reason = "had not finished") const
  {
    EXPECT_NE(log().find("warning: the directory held a run that " + reason + ". Its results are in run/" +
                         folder + " now"),
              std::string::npos)
        << log();
    EXPECT_EQ(n_rows(results() + "/" + folder), n_rows_before);
    for (const char *const name : {"interface.h5", "log.txt", "parameters.prm", "solution-00000.h5"})
      EXPECT_TRUE(std::filesystem::exists(results() + "/" + folder + "/" + name)) << name;
  }
};

TEST_F(EarlierRun, FilesOfOthersStayAndTheRunIsRefused)
{
  std::filesystem::create_directory(results());
  write("statistics.csv", "1,2,3\n");
  write("solution-00007.h5", "other");
  write("notes.txt", "mine");
  const auto before = everything();
  for (const unsigned int n_processes : {1u, 2u})
  {
    const Result refused = run_gemmule(directory, run(brief), n_processes, time_limit(60));
    EXPECT_EQ(refused.exit_code, 1) << refused.out;
    EXPECT_NE(
        refused.err.find("gemmule: error: The output directory 'run' holds 'solution-00007.h5' and "
                         "'statistics.csv', which no run of gemmule has written there and a run would "
                         "replace. Move them elsewhere, or choose another directory with --output or the "
                         "parameter 'Output directory'.\n"),
        std::string::npos)
        << refused.err;
    EXPECT_EQ(everything(), before);
  }
  // As the message says.
  std::filesystem::remove(results() + "/statistics.csv");
  std::filesystem::remove(results() + "/solution-00007.h5");
  EXPECT_EQ(run_gemmule(directory, run(brief)).exit_code, 0);
  EXPECT_EQ(directory.read("run/notes.txt"), "mine");
}

TEST_F(EarlierRun, AFinishedRunIsReplacedAndPicturesStay)
{
  ASSERT_EQ(run_gemmule(directory, run(brief)).exit_code, 0);
  write("snapshots.png", "picture");
  ASSERT_EQ(run_gemmule(directory, run("--set 'End time=0.001'")).exit_code, 0);
  EXPECT_EQ(log().find("warning"), std::string::npos) << log();
  EXPECT_FALSE(std::filesystem::exists(results() + "/earlier-run"));
  EXPECT_EQ(directory.read("run/snapshots.png"), "picture");
  EXPECT_EQ(std::stod(read_text_table(results() + "/statistics.csv").at("time").back()), 0.001);
}

TEST_F(EarlierRun, WithoutAnyUsableCheckpointItIsKept)
{
  ASSERT_EQ(run_gemmule(directory, run(brief)).exit_code, 0);
  const std::size_t n = n_rows(results());
  for (const std::string &path : complete_checkpoints())
    std::ofstream(path + "/metadata.txt").flush();
  const Result resumed = run_gemmule(directory, run("--resume --set 'End time=0.003'"));
  EXPECT_EQ(resumed.exit_code, 1);
  EXPECT_NE(
      resumed.err.find("Restore one from a copy, or leave out --resume to begin anew (the results are kept "
                       "in a folder 'earlier-run' there), or name the right directory with --output."),
      std::string::npos)
      << resumed.err;
  ASSERT_EQ(run_gemmule(directory, run(brief)).exit_code, 0);
  expect_moved_to("earlier-run", n, "lacks its last checkpoint");
  EXPECT_NE(log().find("it has no checkpoint that this version could continue."), std::string::npos) << log();
}

TEST_F(EarlierRun, ThatWasKilledIsKept)
{
  RunningProgram program(directory, run());
  ASSERT_TRUE(program.wait_for([&] { return n_rows(results()) >= 3; }));
  program.send(SIGKILL);
  ASSERT_EQ(program.wait(), 128 + SIGKILL);
  ASSERT_EQ(complete_checkpoints().size(), 1u) << "that of the start";
  const std::size_t n = n_rows(results());
  ASSERT_EQ(run_gemmule(directory, run(brief)).exit_code, 0);
  expect_moved_to("earlier-run", n);
  ASSERT_EQ(run_gemmule(directory, run("--resume", "run/earlier-run")).exit_code, 0);
  Comparison().results(reference(), results() + "/earlier-run");
}

TEST_F(EarlierRun, ThatWasExtendedAndKilledIsKept)
{
  ASSERT_EQ(run_gemmule(directory, run(brief)).exit_code, 0);
  const std::size_t n = n_rows(results());
  RunningProgram program(directory, run("--resume"));
  ASSERT_TRUE(program.wait_for([&] { return n_rows(results()) > n; }));
  program.send(SIGKILL);
  ASSERT_EQ(program.wait(), 128 + SIGKILL);
  const std::size_t n_extended = n_rows(results());
  ASSERT_EQ(run_gemmule(directory, run(brief)).exit_code, 0);
  expect_moved_to("earlier-run", n_extended);
}

TEST_F(EarlierRun, OfAVersionWithoutLocksIsRecognised)
{
  ASSERT_EQ(run_gemmule(directory, run("--set 'Checkpoint/Wall time limit=1e-6'")).exit_code, 3);
  std::filesystem::remove(results() + "/.lock");
  ASSERT_EQ(run_gemmule(directory, run(brief)).exit_code, 0);
  expect_moved_to("earlier-run", 1);
  std::filesystem::remove(results() + "/.lock");
  ASSERT_EQ(run_gemmule(directory, run(brief)).exit_code, 0) << "finished, and so replaced";
  EXPECT_FALSE(std::filesystem::exists(results() + "/earlier-run-2"));
}

TEST_F(EarlierRun, ThatEndedBeforeItsFirstCheckpointBeginsAnewWhenResumed)
{
  ASSERT_EQ(run_gemmule(directory, run("--set 'Checkpoint/Wall time limit=1e-6'")).exit_code, 3);
  for (const std::string &path : complete_checkpoints())
    std::filesystem::remove(path + "/metadata.txt");
  resume_to_the_end();
  EXPECT_NE(
      log().find("warning: --resume: the run in this directory had ended before its first checkpoint. It "
                 "begins anew."),
      std::string::npos)
      << log();
  Comparison().results(reference(), results());
}

TEST_F(EarlierRun, ResumedMovesAsideWhatIsNotItsOwn)
{
  ASSERT_EQ(run_gemmule(directory, run("--set 'Checkpoint/Wall time limit=1e-6'")).exit_code, 3);
  write("interface.h5", "garbage");
  write("solution-00003.h5", "other");
  resume_to_the_end();
  EXPECT_EQ(directory.read("run/earlier-run/interface.h5"), "garbage");
  EXPECT_EQ(directory.read("run/earlier-run/solution-00003.h5"), "other");
  EXPECT_NE(
      log().find("warning: what 'interface.h5' and 'solution-00003.h5' held is not known as written by a run "
                 "of gemmule; it is in run/earlier-run now."),
      std::string::npos)
      << log();
  Comparison().results(reference(), results());
}
