// SPDX-License-Identifier: LGPL-2.1-or-later
// Signals that would end the program save the state, or end the set-up at once.
#include "survival_fixture.h"

using namespace Gemmule::Testing;

namespace
{
const std::vector<std::pair<int, std::string>> all_signals = {
    {SIGINT, "SIGINT"},       {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"},
    {SIGQUIT, "SIGQUIT"},     {SIGUSR1, "SIGUSR1"}, {SIGUSR2, "SIGUSR2"},
    {SIGXCPU, "SIGXCPU"},     {SIGALRM, "SIGALRM"}, {SIGVTALRM, "SIGVTALRM"},
    {SIGPROF, "SIGPROF"},     {SIGIO, "SIGIO"},     {SIGPWR, "SIGPWR"},
    {SIGSTKFLT, "SIGSTKFLT"}, {34, "SIGRTMIN"},     {SIGRTMIN + 7, "SIGRTMIN+7"}};

/** Steps of some hundredths of a second, more of them than any test waits for. */
const std::string many_steps = R"(
set End time = 100
subsection Membrane
  set Tension model = prescribed
end
subsection Mesh
  set Bulk level           = 2
  set Membrane level       = 4
  set Phase boundary level = 4
end
subsection Time stepping
  set Initial time step = 1e-4
  set Largest time step = 1e-4
end
subsection Output
  set Progress line = false
end
)";

/** So many cells at the membrane that setting it up takes a second or more. */
const std::string long_setup = "--set 'Mesh/Membrane level=9' --set 'Mesh/Phase boundary level=9' ";
} // namespace

class Signals : public RunsOfACase
{
protected:
  Signals() : RunsOfACase(many_steps) {}

  std::size_t n_rows() const { return Gemmule::Testing::n_rows(results()); }
  void wait_for_set_up(RunningProgram &program) const
  {
    // The last one that it begins to catch.
    ASSERT_TRUE(program.wait_for([&] { return program.catches(SIGRTMAX); })) << errors();
  }
  /** Waits for a step of the run that has begun. */
  void wait_for_a_step(RunningProgram &program, const std::size_t rows_before = 0) const
  {
    ASSERT_TRUE(program.wait_for([&] { return n_rows() >= rows_before + 2; })) << errors();
  }
  /** The files of the results with their content. */
  std::map<std::string, std::string> files() const
  {
    std::map<std::string, std::string> contents;
    for (const auto &entry : std::filesystem::recursive_directory_iterator(results()))
      if (entry.is_regular_file())
      {
        const std::string name = std::filesystem::relative(entry.path(), directory.path).string();
        contents[name] = directory.read(name);
      }
    return contents;
  }
  /** A run that a time limit has stopped before its first step. */
  void make_stopped_run(const std::string &options = "") const
  {
    const Result result = run_gemmule(directory, run(options + "--set 'Checkpoint/Wall time limit=1e-6'"));
    ASSERT_EQ(result.exit_code, 3) << result.err;
  }

  static constexpr const char *setup_message =
      " while the case was being set up; nothing has been written.\n";
};

TEST_F(Signals, EachSavesTheStateAndIsNamed)
{
  std::string resume;
  for (const auto &[signal, name] : all_signals)
  {
    const std::size_t rows_before = n_rows();
    RunningProgram program(directory, run(resume));
    wait_for_a_step(program, rows_before);
    program.send(signal);
    ASSERT_EQ(program.wait(), 3) << name << errors();
    EXPECT_NE(log().find("stopped by signal " + name + " at t = "), std::string::npos) << log();
    resume = "--resume ";
  }
  EXPECT_EQ(count(log(), "; the state is saved in run/checkpoint/"), all_signals.size()) << log();
}

TEST_F(Signals, EachEndsTheSetUpAtOnceAndTouchesNothing)
{
  make_stopped_run();
  const auto before = files();
  for (const auto &[signal, name] : all_signals)
  {
    RunningProgram program(directory, run(long_setup));
    wait_for_set_up(program);
    program.send(signal);
    EXPECT_EQ(program.wait(), 128 + signal) << name;
    EXPECT_EQ(errors(), "gemmule: stopped by " + name + setup_message);
  }
  EXPECT_TRUE(files() == before);
}

TEST_F(Signals, TheSetUpOfAResumedRunEndsAtOnceAndTouchesNothing)
{
  make_stopped_run(long_setup);
  const auto before = files();
  RunningProgram program(directory, run("--resume " + long_setup));
  wait_for_set_up(program);
  program.send(SIGTERM);
  EXPECT_EQ(program.wait(), 128 + SIGTERM);
  EXPECT_EQ(errors(), std::string("gemmule: stopped by SIGTERM") + setup_message);
  EXPECT_TRUE(files() == before);
}

TEST_F(Signals, TheSetUpOnSeveralRanksEndsAtOnce)
{
  const auto all_catch = [](const RunningProgram &program)
  {
    const auto ranks = program.children();
    return ranks.size() == 2 &&
           std::all_of(ranks.begin(), ranks.end(),
                       [](const pid_t rank) { return RunningProgram::catches(rank, SIGRTMAX); });
  };
  // To all, and to one alone.
  for (const bool is_alone : {false, true})
  {
    RunningProgram program(directory, run(long_setup), 2);
    ASSERT_TRUE(program.wait_for([&] { return all_catch(program); })) << errors();
    if (is_alone)
      kill(program.children().back(), SIGUSR1);
    else
      program.send(SIGUSR1);
    EXPECT_EQ(program.wait(), 128 + SIGUSR1) << errors();
    EXPECT_LE(count(errors(), setup_message), 1u) << errors();
    EXPECT_FALSE(std::filesystem::exists(results()));
  }
}

TEST_F(Signals, OneRankAloneIsEnough)
{
  RunningProgram program(directory, run(), 2);
  wait_for_a_step(program);
  const auto ranks = program.children();
  ASSERT_EQ(ranks.size(), 2u);
  kill(ranks.back(), SIGXCPU);
  EXPECT_EQ(program.wait(), 3) << errors();
  EXPECT_NE(log().find("stopped by signal SIGXCPU at t = "), std::string::npos) << log();
}

TEST_F(Signals, TheLimitOfProcessorTimeSavesTheState)
{
  RunningProgram program(directory, run());
  wait_for_a_step(program);
  program.limit_cpu_time(1);
  EXPECT_EQ(program.wait(), 3) << errors();
  EXPECT_NE(log().find("stopped by signal SIGXCPU at t = "), std::string::npos) << log();
}

TEST_F(Signals, ThoseThatWereIgnoredBeforeStayIgnored)
{
  for (const int ignored : {SIGHUP, SIGINT, SIGQUIT, SIGUSR2})
  {
    RunningProgram program(directory, run("--set 'Checkpoint/Wall clock interval=0'"), 1, ignored);
    wait_for_a_step(program);
    program.send(ignored);
    const std::size_t n = n_rows();
    EXPECT_TRUE(program.wait_for([&] { return n_rows() > n + 5; })) << errors();
    program.send(SIGTERM);
    EXPECT_EQ(program.wait(), 3) << errors();
    EXPECT_NE(log().find("stopped by signal SIGTERM at t = "), std::string::npos) << log();
    std::filesystem::remove_all(results());
  }
}

TEST_F(Signals, HaltedAndContinuedTheRunGoesOn)
{
  RunningProgram program(directory, run());
  wait_for_a_step(program);
  program.send(SIGTSTP);
  program.send(SIGCONT);
  const std::size_t n = n_rows();
  EXPECT_TRUE(program.wait_for([&] { return n_rows() > n + 5; })) << errors();
}

// Batch systems repeat them, and every one may come while the state is being saved or the program ends.
TEST_F(Signals, MoreOfThemDisturbNothing)
{
  RunningProgram program(directory, run());
  wait_for_a_step(program);
  while (program.is_running())
    for (const int signal : {SIGTERM, SIGXCPU, SIGUSR1, SIGINT})
      program.send(signal);
  EXPECT_EQ(program.wait(), 3) << errors();
  EXPECT_EQ(count(log(), "stopped by signal "), 1u) << log();
  EXPECT_EQ(run_gemmule(directory, run("--resume --set 'Checkpoint/Wall time limit=1e-6'")).exit_code, 3);
}

TEST_F(Signals, AfterTheLastStepChangeNothing)
{
  RunningProgram program(directory, run("--set 'End time=1e-4'"));
  ASSERT_TRUE(program.wait_for([&] { return log().find("finished: t = ") != std::string::npos; }))
      << errors();
  while (program.is_running())
    program.send(SIGTERM);
  EXPECT_EQ(program.wait(), 0) << errors();
}

TEST_F(Signals, ASecondCtrlCEndsTheRunWithoutHarm)
{
  // The first one may be answered before the second one comes: the run has to be in the middle of a step.
  int code = 3;
  for (unsigned int attempt = 0; attempt < 10 && code == 3; ++attempt)
  {
    std::filesystem::remove_all(results());
    make_stopped_run();
    // The newest one: of the two that are kept, a new one replaces the other.
    std::string newest;
    for (const auto &entry : std::filesystem::directory_iterator(directory.file("run/checkpoint")))
      newest = std::max(newest, "run/checkpoint/" + entry.path().filename().string() + "/metadata.txt");
    const auto checkpoint = directory.read(newest);
    const std::size_t rows_before = n_rows();
    RunningProgram program(directory, run("--resume"));
    wait_for_a_step(program, rows_before);
    program.send(SIGINT);
    program.wait_for([&] { return !errors().empty(); });
    program.send(SIGSTOP);
    EXPECT_EQ(errors(),
              "gemmule: SIGINT: the state is saved as soon as the present attempt at a step is done. "
              "Another one ends the program at once, without saving.\n");
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
    program.send(SIGINT);
    program.send(SIGCONT);
    code = program.wait();
    EXPECT_EQ(directory.read(newest), checkpoint);
  }
  EXPECT_EQ(code, 128 + SIGINT);
  EXPECT_EQ(run_gemmule(directory, run("--resume --set 'Checkpoint/Wall time limit=1e-6'")).exit_code, 3);
}
