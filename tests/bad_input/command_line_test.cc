// SPDX-License-Identifier: LGPL-2.1-or-later
// Command lines that are right but do not compute, messages of parallel runs, permissions, and what happens
// to the results of earlier runs. The messages about wrong command lines are in command_lines.txt.
#include <gemmule/parameters/all_parameters.h>
#include <gemmule/parameters/expression_names.h>

#include <sys/stat.h>

#include "bad_input_fixture.h"

namespace Gemmule::Testing
{
using CommandLine = BadInput;

TEST_F(CommandLine, HelpExplains)
{
  const Result result = run_gemmule(directory, "--help");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  for (const char *part : {"CASE.prm", "--set", "--output", "--resume", "--check", "--print-parameters",
                           "--help-expressions", "--version", "Examples:", "mpirun", "Exit codes:"})
    EXPECT_NE(result.out.find(part), std::string::npos) << part;
}

TEST_F(CommandLine, VersionNamesTheLibraries)
{
  const Result result = run_gemmule(directory, "--version");
  EXPECT_EQ(result.exit_code, 0);
  for (const char *part : {"Gemmule ", "revision", "deal.II 9", "Trilinos", "p4est"})
    EXPECT_NE(result.out.find(part), std::string::npos) << result.out;
}

TEST_F(CommandLine, HelpOnExpressionsExplainsThem)
{
  const Result result = run_gemmule(directory, "--help-expressions");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.out, Parameters::expression_help());
}

TEST_F(CommandLine, PrintedParametersAreAValidCase)
{
  const Result defaults = run_gemmule(directory, "--print-parameters");
  ASSERT_EQ(defaults.exit_code, 0) << defaults.err;
  directory.write("case.prm", defaults.out);

  const Result again = run_gemmule(directory, "case.prm --print-parameters");
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_EQ(again.out, defaults.out);

  const Result changed =
      run_gemmule(directory, "case.prm --print-parameters --output there --set 'Fluid/Viscosity ratio=0.1'");
  EXPECT_NE(changed.out.find("set Output directory = there"), std::string::npos) << changed.out;
  EXPECT_NE(changed.out.find("set Viscosity ratio  = 0.1"), std::string::npos) << changed.out;
}

TEST_F(CommandLine, CheckAcceptsAndWritesNothing)
{
  directory.write("case.prm", "subsection Mesh\nset Membrane level = 4\nset Phase boundary level = 4\nend\n"
                              "subsection Membrane\nset Cahn number = 0.05\nend\n");
  const auto before = listing();
  const Result result = run_gemmule(directory, "case.prm --check");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_accepted(result, "case.prm");
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(listing(), before);
}

TEST_F(CommandLine, CheckWarnsOfWhatCanBeComputedAndShouldNot)
{
  directory.write("case.prm", "subsection Mesh\nset Membrane level = 4\nset Phase boundary level = 4\nend\n");
  const Result coarse = run_gemmule(directory, "case.prm --check");
  EXPECT_EQ(coarse.exit_code, 0) << coarse.err;
  EXPECT_NE(
      coarse.out.find("warning: the cells of 'Mesh/Phase boundary level' have edges of 0.125, 6.25 times "
                      "'Membrane/Cahn number' = 0.02"),
      std::string::npos)
      << coarse.out;
  EXPECT_NE(coarse.out.find("case.prm: the parameters are valid.\n"), std::string::npos);
  const Result ill_posed = run_gemmule(
      directory, "case.prm --check --set 'Membrane/Regularisation of the total concentration/Model=none'");
  EXPECT_NE(ill_posed.out.find("warning: The total concentration is ill-posed"), std::string::npos)
      << ill_posed.out;
}

TEST_F(CommandLine, TheParameterFileOfTheUserIsNotReplaced)
{
  const std::string content =
      "# by hand\nset End time = 1e-4\nsubsection Mesh\nset Membrane level = 4\nend\n";
  directory.write("parameters.prm", content);
  for (const std::string output : {"--output .", "--output ./", "--output ''$PWD"})
    EXPECT_NE(message_of("parameters.prm " + output).find("would replace its own parameter file"),
              std::string::npos)
        << output;
  EXPECT_EQ(directory.read("parameters.prm"), content);
}

TEST_F(CommandLine, CheckFindsTheSameMistakesAsARun)
{
  directory.write("case.prm", "subsection Membrane\nset Level set = (x-0.8)^2+y^2-0.25\nend\n");
  EXPECT_EQ(message_of("case.prm --check"), message_of("case.prm"));
}

class BadInputOnTwoProcesses : public BadInput
{
protected:
  void expect_one_message(const std::string &content, const std::string &message)
  {
    directory.write("case.prm", content);
    const Result result = run_gemmule(directory, "case.prm --check", 2);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.err.find("gemmule: error: " + message), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("gemmule: error: "), result.err.rfind("gemmule: error: ")) << result.err;
    EXPECT_EQ(result.err.find("TimerOutput"), std::string::npos) << result.err;
  }
};

TEST_F(BadInputOnTwoProcesses, AllFindTheSameMistake)
{
  expect_one_message("set End tim = 1\n", "case.prm:1: there is no parameter 'End tim'");
  expect_one_message("subsection Membrane\nset Initial concentration = sqrt(x)\nend\n",
                     "case.prm:2: Membrane/Initial concentration: the expression has the value");
}

TEST_F(BadInputOnTwoProcesses, OneFindsAMistake)
{
  // not finite in one corner of the box
  expect_one_message("subsection Membrane\nset Level set = x^2+y^2-0.25+0*sqrt(1.93-x-y)\nend\n",
                     "case.prm:2: Membrane/Level set: the expression has the value");
}

/** Runs the program as a user without rights, since root may read and write everything. */
class BadPermissions : public BadInput
{
protected:
  void SetUp() override
  {
    if (geteuid() == 0)
      prefix = "setpriv --reuid=65534 --regid=65534 --clear-groups ";
    std::filesystem::permissions(directory.path, std::filesystem::perms::all);
    const Result result = run_gemmule(directory, "--version", 1, prefix);
    if (result.exit_code != 0)
      GTEST_SKIP() << "this user cannot run the program as one without rights:\n" << result.err;
  }

  void expect_message(const std::string &arguments, const std::string &message)
  {
    const Result result = run_gemmule(directory, arguments, 1, prefix);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "gemmule: error: " + message + "\n");
  }

  std::string prefix;
};

TEST_F(BadPermissions, UnreadableFile)
{
  std::filesystem::permissions(directory.write("secret.prm", ""), std::filesystem::perms::none);
  expect_message("secret.prm", "the parameter file 'secret.prm' cannot be read. Check its permissions.");
}

TEST_F(BadPermissions, UnwritableDirectory)
{
  directory.write("case.prm", "subsection Mesh\nset Membrane level = 4\nset Phase boundary level = 4\nend\n");
  const auto readable = std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec |
                        std::filesystem::perms::others_read | std::filesystem::perms::others_exec;
  std::filesystem::create_directory(directory.path / "locked");
  std::filesystem::permissions(directory.path / "locked", readable);
  expect_message("case.prm --output locked",
                 "Cannot write to the output directory 'locked': change its permissions, or "
                 "choose another one with --output or the parameter 'Output directory'.");
  expect_message(
      "case.prm --output locked/below",
      "Cannot create the output directory 'locked/below' (Permission denied): choose another one with "
      "--output or the parameter 'Output directory'.");
  EXPECT_TRUE(std::filesystem::is_empty(directory.path / "locked"));
}

/** Gives the parameter file through a pipe, which can be read only once; each run has a time limit. */
class ParameterFileInAPipe : public BadInput, public ::testing::WithParamInterface<unsigned int>
{
protected:
  /** @param writer a command in shell syntax whose output is the standard input of the program */
  Result run_behind(const std::string &writer, const std::string &arguments) const
  {
    return run_gemmule(directory, arguments, GetParam(),
                       time_limit(60) + "sh -c '" + writer + " | \"$0\" \"$@\"' ");
  }

  static std::string small_case(const std::string &more = "")
  {
    return "subsection Mesh\nset Membrane level = 4\nset Phase boundary level = 4\nend\n"
           "subsection Membrane\nset Cahn number = 0.05\nend\n" +
           more;
  }
};

TEST_P(ParameterFileInAPipe, IsReadFromStandardInput)
{
  directory.write("case.prm", small_case());
  const Result checked = run_behind("cat case.prm", "/dev/stdin --check");
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  expect_accepted(checked, "/dev/stdin");
  const Result printed = run_behind("cat case.prm", "/dev/stdin --print-parameters");
  EXPECT_EQ(printed.exit_code, 0) << printed.err;
  EXPECT_EQ(printed.out, run_gemmule(directory, "case.prm --print-parameters").out);
}

TEST_P(ParameterFileInAPipe, IsReadFromANamedPipe)
{
  directory.write("case.prm", small_case());
  ASSERT_EQ(mkfifo(directory.file("pipe").c_str(), 0600), 0);
  const Result result = run_behind("cat case.prm > pipe & true", "pipe --check");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_accepted(result, "pipe");
}

TEST_P(ParameterFileInAPipe, IsComputedAndResumed)
{
  directory.write("case.prm", small_case("set End time = 1e-4\n"));
  const Result first = run_behind("cat case.prm", "/dev/stdin --output run");
  EXPECT_EQ(first.exit_code, 0) << first.err;
  directory.write("longer.prm", small_case("set End time = 2e-4\n"));
  const Result second = run_behind("cat longer.prm", "/dev/stdin --output run --resume");
  EXPECT_EQ(second.exit_code, 0) << second.err;
  AllParameters used;
  used.parse(directory.file("run/parameters.prm"));
  EXPECT_EQ(used.end_time, 2e-4);
}

TEST_P(ParameterFileInAPipe, GetsOneMessageAboutAMistake)
{
  const Result result = run_behind("echo set End tim = 1", "/dev/stdin --check");
  EXPECT_EQ(result.exit_code, 1);
  const std::string message =
      "gemmule: error: /dev/stdin:1: there is no parameter 'End tim' at the top level.";
  EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("gemmule: error: "), result.err.rfind("gemmule: error: ")) << result.err;
}

TEST_P(ParameterFileInAPipe, MayNotBeEndless)
{
  const Result result = run_behind("yes", "/dev/stdin --check");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(
      result.err.find("gemmule: error: '/dev/stdin' is larger than 10 MB and no parameter file. Give the "
                      "parameter file (*.prm), which is plain text."),
      std::string::npos)
      << result.err;
}

TEST_P(ParameterFileInAPipe, MayBeEmpty)
{
  const Result result = run_behind("true", "/dev/stdin --print-parameters");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, run_gemmule(directory, "--print-parameters").out);
}

INSTANTIATE_TEST_SUITE_P(, ParameterFileInAPipe, ::testing::Values(1u, 2u),
                         [](const auto &info)
                         { return std::to_string(info.param) + (info.param == 1 ? "Rank" : "Ranks"); });

TEST_F(BadPermissions, DirectoryThatCannotBeSearchedOrRead)
{
  using std::filesystem::perms;
  directory.write("case.prm", "subsection Mesh\nset Membrane level = 4\nset Phase boundary level = 4\nend\n");
  std::filesystem::create_directory(directory.path / "closed");
  std::filesystem::create_directory(directory.path / "unreadable");
  std::filesystem::permissions(directory.path / "closed", perms::none);
  std::filesystem::permissions(directory.path / "unreadable", perms::owner_write | perms::owner_exec |
                                                                  perms::others_write | perms::others_exec);
  const std::string choose = "choose another one with --output or the parameter 'Output directory'.";
  for (const std::string options : {"", " --resume"})
  {
    expect_message(
        "case.prm --output closed/run" + options,
        "Cannot reach the output directory 'closed/run' (Permission denied): change the permissions "
        "above it, or " +
            choose);
    expect_message("case.prm --output closed" + options,
                   "Cannot write to the output directory 'closed': change its permissions, or " + choose);
    expect_message(
        "case.prm --output unreadable" + options,
        "Cannot read the output directory 'unreadable' (Permission denied): change its permissions, "
        "or " +
            choose);
  }
  std::filesystem::permissions(directory.path / "unreadable", perms::all);
  EXPECT_TRUE(std::filesystem::is_empty(directory.path / "unreadable"));
}

using EarlierResults = BadInput;

TEST_F(EarlierResults, SurviveAMistake)
{
  directory.write("case.prm", "set Output directory = results\nset End time = 1e-4\n"
                              "subsection Mesh\nset Membrane level = 4\nset Phase boundary level = 4\nend\n"
                              "subsection Output\nset Field output interval = 1e-4\nend\n");
  const Result first = run_gemmule(directory, "case.prm");
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const std::initializer_list<std::string> names = {"statistics.csv", "log.txt",           "parameters.prm",
                                                    "interface.h5",   "solution-00000.h5", "solution.xdmf"};
  std::vector<std::string> before;
  for (const auto &name : names)
    before.push_back(directory.read("results/" + name));
  for (const char *wrong : {"End tim=1", "Mesh/Membrane level=9", "Membrane/Level set=1+x^2",
                            "Membrane/Level set=(x-0.8)^2+y^2-0.25", "Membrane/Initial total concentration=x",
                            "Membrane/Double well=unknown", "Domain/Boundary velocity=x; y"})
  {
    message_of(std::string("case.prm --set '") + wrong + "'");
    std::vector<std::string> after;
    for (const auto &name : names)
      after.push_back(directory.read("results/" + name));
    EXPECT_EQ(after, before) << wrong;
  }
}
} // namespace Gemmule::Testing
