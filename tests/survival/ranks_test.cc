// SPDX-License-Identifier: LGPL-2.1-or-later
// More ranks than there are cells for: those without cells take part in everything and change nothing.
#include "survival_fixture.h"

using namespace Gemmule::Testing;

namespace
{
/** Sixteen cells in families of four, with all that a step may consist of. */
const std::string few_cells = R"(
set End time = 0.002
subsection Membrane
  set Level set             = x^2+1.1*y^2-0.2
  set Cahn number           = 0.2
  set Initial concentration = 0.5+0.2*sin(3*x)
  subsection Arclength constraint
    set Model = multiplier
  end
  subsection Bending
    set Rigidity at composition 0 = 1e-3
    set Rigidity at composition 1 = 2e-3
  end
end
subsection Mesh
  set Bulk level           = 0
  set Membrane level       = 2
  set Phase boundary level = 2
  set Finest level         = 2
  set Flow error tolerance = 0.1
end
subsection Time stepping
  set Adaptive          = false
  set Initial time step = 1e-3
  set Largest time step = 1e-3
end
subsection Output
  set Field output interval     = 1e-3
  set Interface output interval = 1e-3
  set Progress line             = false
end
)";

/** The ranks that own cells in the fields of the start. */
std::set<double> ranks_with_cells(const std::string &results)
{
  const std::vector<double> owners =
      Gemmule::Hdf5File(results + "/solution-00000.h5", Gemmule::Hdf5File::Mode::read).read("subdomain");
  return {owners.begin(), owners.end()};
}
} // namespace

TEST(Ranks, WithoutCellsChangeNothing)
{
  const TemporaryDirectory directory;
  directory.write("case.prm", few_cells);
  const Result alone = run_gemmule(directory, "case.prm --output alone");
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_EQ(ranks_with_cells(directory.file("alone")), (std::set<double>{0.}));

  const Result checked = run_gemmule(directory, "case.prm --check", 5);
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  const Result begun =
      run_gemmule(directory, "case.prm --output many --set 'Checkpoint/Wall time limit=1e-6'", 5);
  ASSERT_EQ(begun.exit_code, 3) << begun.err;
  EXPECT_EQ(ranks_with_cells(directory.file("many")).size(), 4u);
  const Result resumed = run_gemmule(directory, "case.prm --output many --resume", 9);
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  Comparison(1e-8).results(directory.file("alone"), directory.file("many"));

  const Result extended = run_gemmule(directory, "case.prm --output many --resume --set 'End time=0.003'", 1);
  ASSERT_EQ(extended.exit_code, 0) << extended.err;
  EXPECT_EQ(directory.read("many/log.txt").find("warning: interface.h5"), std::string::npos);
}

TEST(Ranks, WithoutCellsBelongToTheFailureOfARun)
{
  const TemporaryDirectory directory;
  directory.write("case.prm", few_cells);
  // The mesh is far too coarse for the tolerance.
  const std::string arguments = "case.prm --output run --set 'Time stepping/Adaptive=true' "
                                "--set 'Time stepping/Smallest time step=5e-4' ";
  const Result result = run_gemmule(directory, arguments, 5);
  EXPECT_EQ(result.exit_code, 2) << result.err;
  EXPECT_EQ(result.err.find("gemmule: error: The time step at t = "), 0u) << result.err;
  EXPECT_TRUE(std::filesystem::exists(directory.file("run/checkpoint/00001/metadata.txt")));
}
