// Wrong command lines, and those that are right but do not compute.
#include "bad_input_fixture.h"

namespace Gemmule::Testing
{
using BadCommandLine = BadInput;

TEST_F(BadCommandLine, NoArguments)
{
  expect_error("", {"no parameter file is given", "gemmule CASE.prm", "--help"});
}

TEST_F(BadCommandLine, MissingFile)
{
  expect_error("absent.prm", {"the parameter file 'absent.prm' does not exist", "--print-parameters"});
}

TEST_F(BadCommandLine, DirectoryAsFile)
{
  std::filesystem::create_directory(directory.path / "folder");
  expect_error("folder", {"'folder' is a directory"});
}

TEST_F(BadCommandLine, UnreadableFile)
{
  if (geteuid() == 0)
    GTEST_SKIP() << "root can read every file";
  std::filesystem::permissions(directory.write("secret.prm", ""), std::filesystem::perms::none);
  expect_error("secret.prm", {"'secret.prm' cannot be read", "permissions"});
}

TEST_F(BadCommandLine, UnknownOptionSuggestsTheNearest)
{
  directory.write("case.prm", "");
  expect_error("case.prm --chekc", {"unknown option '--chekc'", "Did you mean '--check'?"});
  expect_error("case.prm --verbose=3", {"unknown option '--verbose=3'", "--help"});
}

TEST_F(BadCommandLine, TwoFiles)
{
  expect_error("one.prm two.prm", {"more than one parameter file: 'one.prm' and 'two.prm'"});
}

TEST_F(BadCommandLine, OptionsWithoutValue)
{
  directory.write("case.prm", "");
  expect_error("case.prm --set", {"the option --set lacks its value"});
  expect_error("case.prm --output", {"the option --output lacks its value"});
  expect_error("case.prm --output ''", {"--output needs the name of a directory"});
}

TEST_F(BadCommandLine, SetWithoutEqualsSign)
{
  directory.write("case.prm", "");
  expect_error("case.prm --check --set 'End time 3'", {"command line: --set 'End time 3' has no '='"});
}

TEST_F(BadCommandLine, SetUnknownNames)
{
  directory.write("case.prm", "");
  expect_error(
      "case.prm --check --set 'Fluid/Viscosity ration=1'",
      {"command line: there is no parameter 'Viscosity ration' in section 'Fluid'", "'Viscosity ratio'"});
  expect_error("case.prm --check --set 'Membran/Cahn number=1'",
               {"command line: there is no section 'Membran' at the top level", "Did you mean 'Membrane'?"});
  expect_error("case.prm --check --set '=1'", {"command line: there is no parameter ''"});
  expect_error("case.prm --check --set 'Fluid=1'", {"'Fluid' at the top level", "name of a section"});
}

TEST_F(BadCommandLine, SetWrongValues)
{
  directory.write("case.prm", "");
  expect_error("case.prm --check --set 'Fluid/Viscosity ratio=low'",
               {"command line: the value 'low' of the parameter 'Fluid/Viscosity ratio'", "a number > 0"});
  expect_error("case.prm --check --set 'Membrane/Level set=x+'",
               {"command line: Membrane/Level set", "'x+'"});
  expect_error("case.prm --check --set 'End time=1' --set 'End time=2'",
               {"command line: the parameter 'End time' is given twice"});
  expect_error("case.prm --check --output a --set 'Output directory=b'",
               {"'Output directory' is given twice"});
}

TEST_F(BadCommandLine, MessageAppearsOnceOnTwoProcesses)
{
  directory.write("case.prm", "set End tim = 1\n");
  const Result result = run_gemmule(directory, "case.prm --check", 2);
  EXPECT_EQ(result.exit_code, 1);
  const std::string message = "gemmule: error: case.prm:1: there is no parameter 'End tim'";
  EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find(message), result.err.rfind(message)) << result.err;
}

TEST_F(BadCommandLine, HelpExplains)
{
  const Result result = run_gemmule(directory, "--help");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  for (const char *part : {"CASE.prm", "--set", "--output", "--resume", "--check", "--print-parameters",
                           "--version", "Examples:", "mpirun", "Exit codes:"})
    EXPECT_NE(result.out.find(part), std::string::npos) << part;
}

TEST_F(BadCommandLine, VersionNamesTheLibraries)
{
  const Result result = run_gemmule(directory, "--version");
  EXPECT_EQ(result.exit_code, 0);
  for (const char *part : {"Gemmule ", "revision", "deal.II 9", "Trilinos", "p4est"})
    EXPECT_NE(result.out.find(part), std::string::npos) << result.out;
}

TEST_F(BadCommandLine, PrintedParametersAreAValidCase)
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
} // namespace Gemmule::Testing
