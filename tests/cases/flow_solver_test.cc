// SPDX-License-Identifier: LGPL-2.1-or-later
// Runs of the program with either solver of the flow.
#include <cmath>
#include <gtest/gtest.h>

#include "support/run_program.h"
#include "support/statistics_table.h"

namespace Gemmule::Testing
{
namespace
{
  /** Phases, bending and a constraint: with all that makes the flow's system larger than velocity and
   * pressure. */
  const std::string bending_vesicle = R"(
set End time = 0.004
subsection Time stepping
  set Initial time step = 0.001
  set Largest time step = 0.001
end
subsection Mesh
  set Bulk level = 4
  set Membrane level = 5
  set Phase boundary level = 5
end
subsection Membrane
  set Level set = x^2 + 2*y^2 - 0.2
  set Cahn number = 0.05
  subsection Bending
    set Rigidity at composition 0 = 0.01
    set Rigidity at composition 1 = 0.01
  end
  subsection Arclength constraint
    set Model = multiplier
  end
end
)";

  class FlowSolvers : public ::testing::Test
  {
  protected:
    TextTable run(const std::string &solver, const unsigned int n_processes, std::string *const log = nullptr,
                  const std::string &settings = "")
    {
      directory.write("case.prm", bending_vesicle);
      const Result result = run_gemmule(directory,
                                        "case.prm --output " + solver +
                                            " --set 'Flow discretisation/Solver=" + solver + "'" + settings,
                                        n_processes);
      EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
      if (log != nullptr)
        *log = directory.read(solver + "/log.txt");
      return read_text_table(directory.file(solver) + "/statistics.csv");
    }

    /** Largest difference of a column, by the largest value in it. */
    static double difference(const TextTable &a, const TextTable &b, const std::string &column)
    {
      double largest = 0., size = 0.;
      EXPECT_EQ(a.at(column).size(), b.at(column).size()) << column;
      for (unsigned int row = 0; row < std::min(a.at(column).size(), b.at(column).size()); ++row)
      {
        const double x = std::stod(a.at(column)[row]), y = std::stod(b.at(column)[row]);
        largest = std::max(largest, std::abs(x - y));
        size = std::max(size, std::abs(x));
      }
      return size > 0. ? largest / size : largest;
    }

    const TemporaryDirectory directory;
  };

  TEST_F(FlowSolvers, GiveTheSameStatistics)
  {
    for (const unsigned int n_processes : {1, 2})
    {
      const TextTable direct = run("direct", n_processes);
      std::string log;
      const TextTable iterative = run("iterative", n_processes, &log);
      for (const std::string column : {"area", "arclength", "mass_f", "mass_total", "energy_total",
                                       "energy_bending", "dissipation_viscous", "max_velocity", "tension_max",
                                       "curvature_max", "deformation", "composition_max", "f_total_max"})
        EXPECT_LT(difference(direct, iterative, column), 1e-6) << column << ", processes: " << n_processes;
      for (const std::string &entry : direct.at("linear_iterations"))
        EXPECT_EQ(entry, "0");
      for (const std::string &entry : iterative.at("linear_iterations"))
      {
        EXPECT_GE(std::stoi(entry), 30) << "two right sides";
        EXPECT_LE(std::stoi(entry), 200);
      }
      EXPECT_NE(log.find("solved by FGMRES with multigrid of 2 levels ("), std::string::npos) << log;
    }
  }

  TEST_F(FlowSolvers, TheLogWarnsOnceWhereIterationsFail)
  {
    std::string log;
    const TextTable fallen_back =
        run("iterative", 1, &log, " --set 'Flow discretisation/Largest number of solver iterations=5'");
    const TextTable direct = run("direct", 1);
    for (const std::string column : {"arclength", "energy_total", "max_velocity"})
      EXPECT_LT(difference(direct, fallen_back, column), 1e-9) << column;
    const auto warning = log.find("The iterative solver of the flow does not converge: after 5 iterations");
    ASSERT_NE(warning, std::string::npos) << log;
    EXPECT_EQ(log.find("The iterative solver of the flow does not converge", warning + 10), std::string::npos)
        << log;
    EXPECT_NE(log.find("This flow was solved directly instead.", warning), std::string::npos) << log;
  }
} // namespace
} // namespace Gemmule::Testing
