// Cases whose membrane or phases cannot be set up, and output directories that cannot be used.
#include "bad_input_fixture.h"

namespace Gemmule::Testing
{
class BadMembrane : public BadInput
{
protected:
  /** Runs a default case on a coarse mesh with one line of the section "Membrane". */
  void expect_membrane_error(const std::string &line, const std::initializer_list<std::string> &fragments)
  {
    expect_file_error("subsection Mesh\nset Membrane level = 5\nset Phase boundary level = 5\nend\n"
                      "subsection Membrane\nset " +
                          line + "\nend\n",
                      fragments);
  }
};

TEST_F(BadMembrane, NoZeroOfTheLevelSetInTheBox)
{
  expect_membrane_error("Level set = x^2+y^2+0.1", {"Membrane/Level set: 'x^2+y^2+0.1'", "no zero in the box",
                                                    "positive everywhere", "for example x^2+2*y^2-0.25"});
  expect_membrane_error("Level set = x^2+y^2-9",
                        {"Membrane/Level set: 'x^2+y^2-9'", "no zero in the box", "negative everywhere"});
}

TEST_F(BadMembrane, LevelSetOfTheWrongSign)
{
  expect_membrane_error("Level set = 0.25-x^2-2*y^2",
                        {"Membrane/Level set: '0.25-x^2-2*y^2'", "negative along all walls",
                         "Change its sign: -(0.25-x^2-2*y^2)"});
}

TEST_F(BadMembrane, TouchesTheWall)
{
  for (const char *expression : {"x^2+y^2-1", "x^2+2*y^2-0.999", "(x+0.5)^2+y^2-0.25"})
    expect_membrane_error(std::string("Level set = ") + expression,
                          {"Membrane/Level set: ", expression, "touches a wall", "Domain/Upper corner"});
}

TEST_F(BadMembrane, LeavesTheBox)
{
  expect_membrane_error("Level set = (x-0.8)^2+y^2-0.25", {"Membrane/Level set: '(x-0.8)^2+y^2-0.25'",
                                                           "leaves the box", "Domain/Lower corner"});
}

TEST_F(BadMembrane, TotalConcentrationIsNotPositive)
{
  for (const char *expression : {"0", "x", "x-0.49", "-1"})
    expect_membrane_error(std::string("Initial total concentration = ") + expression,
                          {"Membrane/Initial total concentration: ", expression, "not positive", "at ("});
}

TEST_F(BadMembrane, ConcentrationIsNotANumber)
{
  expect_membrane_error("Initial concentration = sqrt(x)",
                        {"Membrane/Initial concentration", "nan at (-", "finite number"});
  expect_membrane_error("Initial total concentration = log(y)",
                        {"Membrane/Initial total concentration", "nan at (", "finite number"});
}

TEST_F(BadMembrane, PrescribedTensionIsNotANumber)
{
  expect_membrane_error("Tension model = prescribed\nset Prescribed tension = sqrt(x)",
                        {"Membrane/Prescribed tension", "nan at (-", "finite number"});
}

TEST_F(BadMembrane, MessageAppearsOnceOnTwoProcesses)
{
  directory.write("case.prm", "subsection Membrane\nset Initial concentration = sqrt(x)\nend\n");
  const Result result = run_gemmule(directory, "case.prm --check", 2);
  EXPECT_EQ(result.exit_code, 1);
  const std::string message = "gemmule: error: Membrane/Initial concentration";
  EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find(message), result.err.rfind(message)) << result.err;
  EXPECT_EQ(result.err.find("TimerOutput"), std::string::npos) << result.err;
}

using BadOutputDirectory = BadMembrane;

TEST_F(BadOutputDirectory, CannotBeCreated)
{
  // A file in the way stops even a user who may write everywhere.
  directory.write("case.prm", "subsection Mesh\nset Membrane level = 4\nset Phase boundary level = 4\nend\n");
  directory.write("occupied", "text");
  expect_error("case.prm --output occupied", {"Cannot create the output directory 'occupied'", "--output"});
  expect_error("case.prm --output occupied/below",
               {"Cannot create the output directory 'occupied/below'", "--output"});
  expect_error("case.prm --output /proc/gemmule", {"Cannot create the output directory '/proc/gemmule'"});
  EXPECT_EQ(directory.read("occupied"), "text");
}

TEST_F(BadOutputDirectory, IsNotWritable)
{
  if (geteuid() == 0)
    GTEST_SKIP() << "root can write everywhere";
  directory.write("case.prm", "subsection Mesh\nset Membrane level = 4\nset Phase boundary level = 4\nend\n");
  std::filesystem::create_directory(directory.path / "locked");
  std::filesystem::permissions(directory.path / "locked", std::filesystem::perms::owner_read);
  expect_error("case.prm --output locked", {"Cannot write to the output directory 'locked'", "permissions"});
}

TEST_F(BadOutputDirectory, KeepsEarlierResultsWhenTheCaseIsWrong)
{
  std::filesystem::create_directory(directory.path / "results");
  const std::initializer_list<std::string> names = {"statistics.csv", "log.txt",           "parameters.prm",
                                                    "interface.h5",   "solution-00000.h5", "solution.xdmf"};
  for (const auto &name : names)
    directory.write("results/" + name, "earlier " + name);
  directory.write("case.prm", "set Output directory = results\n");
  for (const char *wrong : {"End tim=1", "Mesh/Membrane level=9", "Membrane/Level set=1+x^2",
                            "Membrane/Level set=(x-0.8)^2+y^2-0.25", "Membrane/Initial total concentration=x",
                            "Membrane/Double well=unknown", "Domain/Boundary velocity=x; y"})
  {
    expect_error(std::string("case.prm --set '") + wrong + "'", {});
    for (const auto &name : names)
      EXPECT_EQ(directory.read("results/" + name), "earlier " + name) << wrong;
  }
}
} // namespace Gemmule::Testing
