// SPDX-License-Identifier: LGPL-2.1-or-later
// Initial membranes that a search on a lattice loses, and level sets in unusual units: what the program makes
// of them, against the exact areas.
#include <cmath>
#include <gtest/gtest.h>

#include "support/run_program.h"
#include "support/statistics_table.h"

using namespace Gemmule::Testing;

namespace
{
constexpr double pi = 3.14159265358979323846;

/** The first row of the statistics of a run without phases. */
class InitialMembrane : public testing::Test
{
protected:
  TemporaryDirectory directory;

  Result run(const std::string &settings, const std::string &level_set, const unsigned int n_processes = 1)
  {
    directory.write("case.prm", "set End time = 1e-6\n"
                                "set Output directory = results\n"
                                "subsection Membrane\n"
                                "  set Tension model = prescribed\n"
                                "  set Level set = " +
                                    level_set +
                                    "\n"
                                    "end\n"
                                    "subsection Output\n"
                                    "  set Field output interval = 0\n"
                                    "end\n"
                                    "subsection Time stepping\n"
                                    "  set Initial time step = 1e-6\n"
                                    "end\n");
    return run_gemmule(directory, "case.prm" + settings, n_processes, "timeout 60 ");
  }

  double first(const std::string &column) const
  {
    const auto table = read_text_table(directory.file("results/statistics.csv"));
    return std::stod(table.at(column).front());
  }
};

const std::string coarse = " --set 'Mesh/Membrane level=4' --set 'Mesh/Phase boundary level=4'";
} // namespace

TEST_F(InitialMembrane, HasTwoVesiclesOfWhichOneIsMuchSmallerThanACellOfTheBulk)
{
  for (const unsigned int n_processes : {1u, 2u})
  {
    const Result result = run(" --set 'Domain/Lower corner=-20,-20' --set 'Domain/Upper corner=20,20'"
                              " --set 'Mesh/Membrane level=9' --set 'Mesh/Phase boundary level=9'"
                              " --set 'Mesh/Finest level=9'",
                              "min((x+10)^2+(y+10)^2-0.16, (x-7.1875)^2+(y-7.1875)^2-0.16)", n_processes);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(first("components"), 2.);
    EXPECT_NEAR(first("area"), 2. * pi * 0.16, 1e-5);
  }
}

TEST_F(InitialMembrane, HasAVesicleThatOnlyCellsFinerThanThoseOfTheMembraneResolve)
{
  const Result result =
      run(coarse + " --set 'Mesh/Finest level=8'", "min(x^2+y^2-0.16, (x-0.7031)^2+(y-0.7031)^2-0.0004)");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(first("components"), 2.);
  EXPECT_NEAR(first("area"), pi * (0.16 + 0.0004), 2e-6);
}

TEST_F(InitialMembrane, IsRefusedWhereAVesicleIsSmallerThanTheFinestCells)
{
  const Result result =
      run(coarse + " --set 'Mesh/Finest level=4'", "min(x^2+y^2-0.16, (x-0.7031)^2+(y-0.7031)^2-0.0001)");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("case.prm:5: Membrane/Level set"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("has a detail near (0.7"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("'Mesh/Finest level'"), std::string::npos) << result.err;
}

TEST_F(InitialMembrane, HasAFilamentThatIsThinnerThanTheCellsOfTheMembrane)
{
  // A dumb-bell: two discs of radius 0.25 and a bridge of thickness 0.04 between them.
  const Result result = run(coarse + " --set 'Mesh/Finest level=8'",
                            "min(sqrt((x-0.6)^2+y^2)-0.25, sqrt((x+0.6)^2+y^2)-0.25, max(abs(y+0.0117)-0.02, "
                            "abs(x)-0.6))");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(first("components"), 1.);
  const double half_length = 0.6 - 0.25;
  EXPECT_NEAR(first("area"), 2. * pi * 0.0625 + 2. * half_length * 0.04, 1e-3);
}

TEST_F(InitialMembrane, HasAVesicleBesideTheWall)
{
  const Result result =
      run(coarse + " --set 'Mesh/Finest level=8'", "min(x^2+y^2-0.16, (x-0.951)^2+(y-0.213)^2-0.0004)");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(first("components"), 2.);
  EXPECT_NEAR(first("area"), pi * (0.16 + 0.0004), 2e-6);
}

TEST_F(InitialMembrane, IsTheSameForEveryMonotoneFunctionOfALevelSet)
{
  ASSERT_EQ(run(coarse, "x^2+2*y^2-0.25").exit_code, 0);
  const double area = first("area"), arclength = first("arclength");
  EXPECT_NEAR(area, pi * 0.25 / std::sqrt(2.), 2e-6);
  for (const std::string text :
       {"1e-8*(x^2+2*y^2-0.25)", "1e-200*(x^2+2*y^2-0.25)", "1e10*(x^2+2*y^2-0.25)",
        "exp(7*(x^2+2*y^2-0.25))-1", "exp(20*(x^2+2*y^2-0.25))-1", "(x^2+2*y^2-0.25)^3",
        "exp(200*(x^2+2*y^2-0.25))-1", "(x^2+2*y^2-0.25)^3", "tanh(1000*(x^2+2*y^2-0.25))",
        "atan(x^2+2*y^2-0.25)", "log(0.75+x^2+2*y^2)", "sqrt(x^2+2*y^2)-0.5", "(x^2+2*y^2)^5-0.25^5"})
  {
    const Result result = run(coarse, text);
    ASSERT_EQ(result.exit_code, 0) << text << ": " << result.err;
    EXPECT_NEAR(first("area"), area, 1e-9) << text;
    EXPECT_NEAR(first("arclength"), arclength, 1e-9) << text;
    EXPECT_EQ(first("components"), 1.);
  }
}

TEST_F(InitialMembrane, MayBeGivenInMetres)
{
  const Result result =
      run(coarse + " --set 'Domain/Lower corner=-2e-5,-2e-5' --set 'Domain/Upper corner=2e-5,2e-5'",
          "x^2+2*y^2-0.25e-10");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NEAR(first("area") / 1e-10, pi * 0.25 / std::sqrt(2.), 1e-4);
}

TEST_F(InitialMembrane, IsSetUpInBoundedTimeWhateverTheExpressionIs)
{
  // Waves below every cell: no mesh is fine enough, which has to be said soon.
  for (const std::string text : {"sin(1e5*x)*sin(1e5*y)+0.5", "x^2+y^2-0.25+0.3*sin(1e6*x*y)"})
  {
    const Result result = run(coarse + " --set 'Mesh/Finest level=20'", text);
    EXPECT_EQ(result.exit_code, 1) << text;
  }
}
