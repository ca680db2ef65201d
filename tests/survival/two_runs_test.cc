// SPDX-License-Identifier: LGPL-2.1-or-later
// Two runs at once in one directory.
#include "survival_fixture.h"

using namespace Gemmule::Testing;

class TwoRuns : public Survival
{
protected:
  void expect_refusal(const std::string &options, const unsigned int n_processes) const
  {
    const Result second = run_gemmule(directory, run(options), n_processes, time_limit(60));
    EXPECT_EQ(second.exit_code, 1) << second.out << second.err;
    EXPECT_NE(
        second.err.find(
            "gemmule: error: Another run of gemmule is writing to the output directory 'run' (process "),
        std::string::npos)
        << second.err;
    EXPECT_EQ(second.err.find("gemmule: error:"), second.err.rfind("gemmule: error:")) << second.err;
  }
};

TEST_F(TwoRuns, TheSecondIsRefusedAndTheFirstUndisturbed)
{
  RunningProgram first(directory, run("--set 'Checkpoint/Steps between checkpoints=2'"));
  ASSERT_TRUE(first.wait_for([&] { return complete_checkpoints().size() == 2; }));
  // Not for long enough to end.
  first.send(SIGSTOP);
  const std::size_t n = n_rows(results());
  expect_refusal("", 1);
  expect_refusal("--resume", 1);
  expect_refusal("", 2);
  EXPECT_EQ(n_rows(results()), n);
  first.send(SIGCONT);
  EXPECT_EQ(first.wait(), 0) << directory.read(".stderr");
  Comparison().results(reference(), results());
}

TEST_F(TwoRuns, ARunThatWasMovedIsNotDisturbedWhileItIsContinued)
{
  // The second one moves the first.
  const std::string interrupted = run("--set 'Checkpoint/Wall time limit=1e-6'");
  for (unsigned int i = 0; i < 2; ++i)
    ASSERT_EQ(run_gemmule(directory, interrupted).exit_code, 3);
  const std::string earlier = results() + "/earlier-run";
  RunningProgram first(directory, run("--resume", "run/earlier-run"));
  const std::size_t n = n_rows(earlier);
  ASSERT_TRUE(first.wait_for([&] { return n_rows(earlier) > n; }));
  // The third moves the second elsewhere.
  ASSERT_EQ(run_gemmule(directory, interrupted).exit_code, 3);
  EXPECT_EQ(n_rows(earlier + "-2"), 1u);
  EXPECT_EQ(first.wait(), 0) << directory.read(".stderr");
  Comparison().results(reference(), earlier);
}

TEST_F(TwoRuns, AKillReleasesTheDirectory)
{
  RunningProgram first(directory, run("--set 'Checkpoint/Steps between checkpoints=2'"));
  ASSERT_TRUE(first.wait_for([&] { return !complete_checkpoints().empty(); }));
  first.send(SIGKILL);
  ASSERT_EQ(first.wait(), 128 + SIGKILL);
  resume_to_the_end();
  Comparison().results(reference(), results());
  // Nor does an end of the ordinary kind leave anything locked.
  EXPECT_EQ(run_gemmule(directory, run("--set 'End time=0.002'")).exit_code, 0);
}
