// SPDX-License-Identifier: LGPL-2.1-or-later
// A run that is interrupted and resumed computes what it would have computed anyway.
#include "survival_fixture.h"

using namespace Gemmule::Testing;

class Resume : public Survival
{
protected:
  /** Starts the run and sends @p signal once it has written @p n rows. @return its exit code */
  int stop_after(const std::size_t n, const int signal, const std::string &options = "",
                 const unsigned int n_processes = 1)
  {
    RunningProgram program(directory, run(options), n_processes);
    EXPECT_TRUE(program.wait_for([&] { return n_rows(results()) >= n; })) << directory.read(".stderr");
    program.send(signal);
    return program.wait();
  }
};

TEST_F(Resume, SignalsStopTheRunAndItContinuesBitwise)
{
  ASSERT_EQ(stop_after(5, SIGTERM), 3) << directory.read(".stderr");
  EXPECT_EQ(directory.read(".stderr"), "");
  EXPECT_NE(log().find("stopped by signal SIGTERM at t = "), std::string::npos) << log();
  EXPECT_NE(log().find("--resume"), std::string::npos);
  ASSERT_EQ(complete_checkpoints().size(), 2u) << "of the start and of the end";

  ASSERT_EQ(stop_after(n_rows(results()) + 6, SIGINT, "--resume"), 3) << directory.read(".stderr");
  EXPECT_NE(log().find("stopped by signal SIGINT at t = "), std::string::npos) << log();
  EXPECT_NE(log().find("resumed at t = "), std::string::npos) << log();
  ASSERT_EQ(stop_after(n_rows(results()) + 6, SIGUSR1, "--resume"), 3) << directory.read(".stderr");
  EXPECT_NE(log().find("stopped by signal SIGUSR1 at t = "), std::string::npos) << log();
  ASSERT_EQ(stop_after(n_rows(results()) + 3, SIGHUP, "--resume"), 3) << directory.read(".stderr");
  EXPECT_NE(log().find("stopped by signal SIGHUP at t = "), std::string::npos) << log();
  EXPECT_LT(n_rows(results()), n_rows(reference()));
  EXPECT_EQ(complete_checkpoints().size(), 2u) << "the last two are kept";

  resume_to_the_end();
  EXPECT_EQ(log().find("warning: "), std::string::npos) << log();
  Comparison().results(reference(), results());
}

TEST_F(Resume, WallTimeLimitStopsTheRun)
{
  // Setting up the case takes longer: it stops after the initial state, before a step.
  const Result first = run_gemmule(directory, run("--set 'Checkpoint/Wall time limit=0.001'"));
  EXPECT_EQ(first.exit_code, 3) << first.err;
  EXPECT_NE(first.out.find("stopped by the wall time limit of 0.001 s at t = 0 "), std::string::npos)
      << first.out;
  EXPECT_EQ(n_rows(results()), 1u);
  // Long enough for a step, but not for all: how long that is depends on what else the machine has to do.
  Result second;
  double limit = 0.05 * reference_seconds;
  do
  {
    second = run_gemmule(directory,
                         run("--resume --set 'Checkpoint/Wall time limit=" + std::to_string(limit) + "'"));
    limit *= 1.5;
  } while (second.exit_code == 3 && n_rows(results()) == 1);
  ASSERT_EQ(second.exit_code, 3) << second.out << second.err;
  EXPECT_GT(n_rows(results()), 1u);
  EXPECT_LT(n_rows(results()), n_rows(reference()));
  resume_to_the_end();
  Comparison().results(reference(), results());
}

TEST_F(Resume, AnotherNumberOfRanksAgreesToSolverTolerance)
{
  // One, then two, then one rank; mpirun passes SIGUSR1 on to all processes.
  ASSERT_EQ(stop_after(8, SIGTERM), 3) << directory.read(".stderr");
  ASSERT_EQ(stop_after(n_rows(results()) + 6, SIGUSR1, "--resume", 2), 3) << directory.read(".stderr");
  EXPECT_NE(log().find("2 process(es)"), std::string::npos);
  resume_to_the_end();
  Comparison(1e-5).results(reference(), results());
}

TEST_F(Resume, BendingAndTheArclengthMultiplierContinueBitwise)
{
  // They carry more from step to step.
  const std::string options = "--set 'Membrane/Bending/Rigidity at composition 0=1e-3' "
                              "--set 'Membrane/Bending/Rigidity at composition 1=2e-3' "
                              "--set 'Membrane/Arclength constraint/Model=multiplier' --set 'End time=0.01' ";
  const Result uninterrupted = run_gemmule(directory, run(options, "uninterrupted"));
  ASSERT_EQ(uninterrupted.exit_code, 0) << uninterrupted.err;
  ASSERT_EQ(stop_after(6, SIGTERM, options), 3) << directory.read(".stderr");
  EXPECT_LT(n_rows(results()), n_rows(directory.file("uninterrupted")));
  resume_to_the_end(options);
  Comparison().results(directory.file("uninterrupted"), results());
}

// The numerical rigidity comes with negative tension and goes with it: whether there is any must not depend
// on what came before.
TEST_F(Resume, AfterATimeOfNegativeTensionContinuesBitwise)
{
  const std::string options = "--set 'Membrane/Tension model=prescribed' "
                              "--set 'Membrane/Prescribed tension=0.3+cos(80*t)' --set 'End time=0.1' "
                              "--set 'Time stepping/Largest time step=0.003' ";
  const Result whole = run_gemmule(directory, run(options, "whole"));
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  const TextTable rows = read_text_table(directory.file("whole/statistics.csv"));
  std::size_t last_negative = 0;
  for (std::size_t i = 0; i < rows.at("time").size(); ++i)
    if (std::stod(rows.at("grid_scale_rigidity")[i]) > 0.)
      last_negative = i;
  ASSERT_GT(last_negative, 5u);
  ASSERT_LT(last_negative + 6, rows.at("time").size());
  ASSERT_EQ(stop_after(last_negative + 4, SIGTERM, options), 3) << directory.read(".stderr");
  ASSERT_LT(n_rows(results()), n_rows(directory.file("whole")));
  resume_to_the_end(options);
  Comparison().results(directory.file("whole"), results());
}

TEST_F(Resume, ASignalIsHeardBetweenAttemptsAtAStep)
{
  // No step can be computed after some time; there are ten attempts until the smallest one has failed.
  const std::string failing = "--set 'Domain/Boundary velocity=20; 0' --set 'Time stepping/Tolerance=1' "
                              "--set 'Time stepping/Initial time step=0.004' "
                              "--set 'Time stepping/Smallest time step=1e-5' "
                              "--set 'Membrane/Repair unresolved shapes=false' ";
  const Result whole = run_gemmule(directory, run(failing, "whole"));
  ASSERT_EQ(whole.exit_code, 2) << whole.out;
  RunningProgram program(directory, run(failing));
  ASSERT_TRUE(
      program.wait_for([&] { return log().find("failed and is repeated with half") != std::string::npos; }));
  program.send(SIGTERM);
  ASSERT_EQ(program.wait(), 3) << log();
  const std::size_t n_accepted = n_rows(results());
  const Result resumed = run_gemmule(directory, run(failing + "--resume"));
  EXPECT_EQ(resumed.exit_code, 2);
  EXPECT_EQ(resumed.err, whole.err);
  EXPECT_GE(n_rows(results()), n_accepted);
  Comparison().statistics(directory.file("whole"), results());
}

TEST_F(Resume, CheckpointsComeAfterTheGivenNumberOfStepsAndTheLastAreKept)
{
  const Result result = run_gemmule(
      directory,
      run("--set 'Checkpoint/Steps between checkpoints=4' "
          "--set 'Checkpoint/Number of checkpoints kept=3' --set 'Checkpoint/Wall clock interval=0'"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  Comparison().results(reference(), results()); // saving does not change what is computed
  const auto kept = complete_checkpoints();
  ASSERT_EQ(kept.size(), 3u);
  const std::size_t n_steps = n_rows(results()) - 1;
  std::vector<std::string> expected_steps{"step = " + std::to_string(n_steps) + "\n"};
  for (std::size_t step = (n_steps - 1) / 4 * 4; expected_steps.size() < 3; step -= 4)
    expected_steps.insert(expected_steps.begin(), "step = " + std::to_string(step) + "\n");
  for (unsigned int i = 0; i < 3; ++i)
  {
    std::ifstream file(kept[i] + "/metadata.txt");
    const std::string metadata(std::istreambuf_iterator<char>(file), {});
    EXPECT_NE(metadata.find(expected_steps[i]), std::string::npos) << metadata;
    for (const char *name : {"schema_version = 6\n", "finished = ", "statistics_columns = ",
                             "git_revision = ", "libraries = deal.II 9", "p4est",
                             "command_line = ", "date = 20", "file parameters.prm = ", "file state.h5 = "})
      EXPECT_NE(metadata.find(name), std::string::npos) << name << " in\n" << metadata;
  }
}

TEST_F(Resume, AFinishedRunIsExtended)
{
  const Result shorter = run_gemmule(directory, run("--set 'End time=0.06'"));
  ASSERT_EQ(shorter.exit_code, 0) << shorter.err;
  const std::size_t n_shorter = n_rows(results());
  // Nothing to do: nothing changes.
  const Result again = run_gemmule(directory, run("--resume --set 'End time=0.06'"));
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(n_rows(results()), n_shorter);
  // The steps are others than those of the longer run, but the physics is the same.
  resume_to_the_end("--set 'End time=0.1' --set 'Output/Interface output interval=0.05'");
  EXPECT_GT(n_rows(results()), n_shorter);
  const auto table = read_text_table(results() + "/statistics.csv");
  const auto longer = read_text_table(reference() + "/statistics.csv");
  EXPECT_DOUBLE_EQ(std::stod(table.at("time").back()), 0.1);
  const auto row = std::find(longer.at("time").begin(), longer.at("time").end(), "0.10000000000000001");
  ASSERT_NE(row, longer.at("time").end());
  const auto i = row - longer.at("time").begin();
  EXPECT_NEAR(std::stod(table.at("arclength").back()), std::stod(longer.at("arclength")[i]), 1e-4);
  // The end may not be put before what has been computed.
  const Result earlier = run_gemmule(directory, run("--resume --set 'End time=0.05'"));
  EXPECT_EQ(earlier.exit_code, 1);
  EXPECT_NE(earlier.err.find("End time"), std::string::npos) << earlier.err;
}

TEST_F(Resume, RefusesOtherParametersAndNamesThem)
{
  const Result none = run_gemmule(directory, run("--resume"));
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("there is no checkpoint in 'run'"), std::string::npos) << none.err;

  ASSERT_EQ(run_gemmule(directory, run("--set 'End time=0.002'")).exit_code, 0);
  const auto before = complete_checkpoints();
  const Result refused =
      run_gemmule(directory, run("--resume --set 'Fluid/Viscosity ratio=3' "
                                 "--set 'Time stepping/Tolerance=2e-4' --set 'End time=0.01'"));
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("Fluid/Viscosity ratio: '1' in the checkpoint, '3' now"), std::string::npos)
      << refused.err;
  EXPECT_NE(refused.err.find("Time stepping/Tolerance: "), std::string::npos) << refused.err;
  EXPECT_EQ(refused.err.find("End time: "), std::string::npos) << refused.err;
  EXPECT_EQ(complete_checkpoints(), before) << "a refusal changes nothing";

  // The directory may have another name now.
  std::filesystem::rename(results(), directory.file("elsewhere"));
  const Result allowed = run_gemmule(
      directory, run("--resume --set 'End time=0.004' --set 'Output/Output times=0.003' "
                     "--set 'Checkpoint/Number of checkpoints kept=1' "
                     "--set 'Checkpoint/Steps between checkpoints=1' --set 'Output/Progress line=true'",
                     "elsewhere"));
  EXPECT_EQ(allowed.exit_code, 0) << allowed.err;
}

TEST_F(Resume, AFailureSavesTheLastAcceptedState)
{
  // The flow tears the membrane away within a few steps.
  const std::string failing = run("--set 'Domain/Boundary velocity=20; 0' --set 'Time stepping/Tolerance=1' "
                                  "--set 'Time stepping/Initial time step=0.004' "
                                  "--set 'Time stepping/Smallest time step=0.002' "
                                  "--set 'Membrane/Repair unresolved shapes=false' ");
  const Result first = run_gemmule(directory, failing);
  ASSERT_EQ(first.exit_code, 2) << first.out;
  EXPECT_NE(first.err.find("'Smallest time step'"), std::string::npos) << first.err;
  const std::size_t n_accepted = n_rows(results());
  EXPECT_GT(n_accepted, 1u);
  EXPECT_NE(log().find("The state of that step is in run/checkpoint/00002"), std::string::npos) << log();
  ASSERT_EQ(complete_checkpoints().size(), 2u) << "of the start and of the end";
  const auto n_groups = [this]
  { return Gemmule::Hdf5File(results() + "/interface.h5", Gemmule::Hdf5File::Mode::read).members().size(); };
  EXPECT_EQ(n_groups(), 3u) << "at t = 0, 0.02, and the last";
  // It is resumed, and fails in the same way, without doubled output.
  const Result second = run_gemmule(directory, failing + "--resume");
  EXPECT_EQ(second.exit_code, 2);
  EXPECT_EQ(first.err, second.err);
  EXPECT_EQ(n_rows(results()), n_accepted);
  EXPECT_EQ(n_groups(), 3u);
}

TEST_F(Resume, ProvenanceIsInTheLogAndInEveryHdf5File)
{
  const Result result = run_gemmule(directory, run("--set 'End time=0.002'"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::vector<std::string> names{"gemmule_version", "git_revision", "libraries",
                                       "command_line",    "date",         "parameters"};
  for (const std::string &name : names)
    EXPECT_NE(log().find("\n" + name + ":"), std::string::npos) << name;
  EXPECT_NE(log().find("Fluid/Viscosity ratio = 1\n"), std::string::npos);
  unsigned int n_files = 0;
  for (const auto &entry : std::filesystem::recursive_directory_iterator(results()))
    if (entry.path().extension() == ".h5")
    {
      ++n_files;
      const Gemmule::Hdf5File file(entry.path(), Gemmule::Hdf5File::Mode::read);
      for (const std::string &name : names)
        ASSERT_TRUE(file.has_attribute("/", name)) << name << " in " << entry.path();
      EXPECT_NE(file.text_attribute("/", "libraries").find("Trilinos"), std::string::npos);
      EXPECT_NE(file.text_attribute("/", "command_line").find("case.prm"), std::string::npos);
      const std::string parameters = file.text_attribute("/", "parameters");
      EXPECT_NE(parameters.find("End time = 0.002\n"), std::string::npos) << parameters;
      EXPECT_EQ(parameters.find("Output directory"), std::string::npos) << "says nothing of this computer";
    }
  EXPECT_GE(n_files, 4u) << "interface.h5 and its copy, the fields, the state";

  // What goes on with a file says so there.
  for (const std::string end : {"0.003", "0.004"})
    ASSERT_EQ(run_gemmule(directory, run("--resume --set 'End time=" + end + "'")).exit_code, 0);
  const Gemmule::Hdf5File file(results() + "/interface.h5", Gemmule::Hdf5File::Mode::read);
  EXPECT_NE(file.text_attribute("/", "resumed_001").find("t = 0.002, 2"), std::string::npos);
  EXPECT_NE(file.text_attribute("/", "resumed_002").find("'End time=0.004'"), std::string::npos);
  EXPECT_FALSE(file.has_attribute("/", "resumed_003"));
}
