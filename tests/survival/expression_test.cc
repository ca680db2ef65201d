// SPDX-License-Identifier: LGPL-2.1-or-later
// Expressions of t that make no sense any more once the run has begun.
#include <ostream>

#include "survival_fixture.h"

using namespace Gemmule::Testing;

namespace
{
const std::string coarse_case = R"(
set End time = 0.2
subsection Membrane
  set Tension model = prescribed
  set Level set     = x^2+2*y^2-0.25
end
subsection Mesh
  set Bulk level     = 3
  set Membrane level = 4
end
subsection Time stepping
  set Adaptive          = false
  set Initial time step = 0.02
end
subsection Output
  set Progress line = false
end
)";

struct FailingExpression
{
  std::string name, parameter, value, complaint;
};

std::ostream &operator<<(std::ostream &out, const FailingExpression &expression)
{
  return out << expression.name;
}

// In the upper half of the box only: of two ranks, one finds it.
const std::vector<FailingExpression> failing_expressions = {
    {"Velocity", "Domain/Boundary velocity", "if(y>0.5,sqrt(0.05-t),0.2); 0",
     "the expression has the value nan at ("},
    {"Tension", "Membrane/Prescribed tension", "if(y>0.1,1+0.01*sqrt(0.05-t),1)",
     "the expression has the value nan at ("},
    {"NetFlux", "Domain/Boundary velocity", "if(t>0.05,x,0); 0", "the flow at the walls pumps fluid"},
    {"Overflow", "Domain/Boundary velocity", "if(t>0.05,1e308*y,0); 0",
     "the velocity at the walls is too large to compute with"}};
} // namespace

class ExpressionOfTime : public RunsOfACase,
                         public testing::WithParamInterface<std::tuple<FailingExpression, unsigned int>>
{
protected:
  ExpressionOfTime() : RunsOfACase(coarse_case) {}

  /** Runs the case until the expression fails. */
  void expect_failure(const std::string &options)
  {
    const auto &[expression, n_ranks] = GetParam();
    const Result result = run_gemmule(
        directory, run("--set '" + expression.parameter + "=" + expression.value + "' " + options), n_ranks,
        time_limit(60));
    EXPECT_EQ(result.exit_code, 2) << result.out << result.err;
    // mpirun has something to say as well, but the program says it once.
    const std::string start =
        "gemmule: error: command line: " + expression.parameter + ": " + expression.complaint;
    EXPECT_NE(result.err.find(start), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("gemmule: error:"), result.err.rfind("gemmule: error:")) << result.err;
    EXPECT_NE(result.err.find("t = 0.06"), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("MPI_ABORT"), std::string::npos) << result.err;

    EXPECT_NE(result.out.find("stopped at t = 0.04 after 6 steps: command line: " + expression.parameter),
              std::string::npos)
        << result.out;
    EXPECT_NE(result.out.find("The state of that step is in run/checkpoint/"), std::string::npos)
        << result.out;
    const auto times = read_text_table(directory.file("run/statistics.csv")).at("time");
    EXPECT_DOUBLE_EQ(std::stod(times.back()), 0.04);
  }
};

TEST_P(ExpressionOfTime, ThatFailsEndsTheRunWithItsStateSaved)
{
  expect_failure("");
  // What was saved can be continued from, to the same end.
  expect_failure("--resume");
}

INSTANTIATE_TEST_SUITE_P(, ExpressionOfTime,
                         testing::Combine(testing::ValuesIn(failing_expressions), testing::Values(1u, 2u)),
                         [](const auto &info)
                         {
                           return std::get<0>(info.param).name + std::to_string(std::get<1>(info.param)) +
                                  (std::get<1>(info.param) == 1 ? "Rank" : "Ranks");
                         });
