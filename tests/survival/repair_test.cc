// SPDX-License-Identifier: LGPL-2.1-or-later
// A membrane that the mesh does not resolve any more: given up, or repaired, also when the run is resumed.
#include "survival_fixture.h"

using namespace Gemmule::Testing;

namespace
{
/**
 * A membrane that wants to be much longer than it is, so that strong negative tension folds it within its
 * cells: after 0.007 time units no step succeeds any more.
 */
const std::string folding_case = R"(
set End time = 0.0075
subsection Membrane
  set Level set             = x^2+8*y^2-0.25
  set Initial concentration = 0.5+0.01*(sin(x)*cos(y)+sin(4*x)*cos(3*y))
  set Cahn number           = 0.05
  subsection Regularisation of the total concentration
    set Model                 = update smoothing
    set Smoothing coefficient = 0.05
  end
  subsection Arclength constraint
    set Model               = penalty
    set Penalty             = 20
    set Reference arclength = 3.2
  end
  subsection Bending
    set Grid-scale rigidity = 0
  end
end
subsection Mesh
  set Membrane level       = 5
  set Phase boundary level = 5
end
subsection Output
  set Field output interval     = 0
  set Interface output interval = 0.0025
  set Progress line             = false
end
subsection Checkpoint
  set Steps between checkpoints  = 10
  set Number of checkpoints kept = 100
end
)";
} // namespace

class Repair : public RunsOfACase
{
protected:
  Repair() : RunsOfACase(folding_case) {}

  Result result_of(const std::string &output, const std::string &options = "", const unsigned int n_ranks = 1)
  {
    return run_gemmule(directory, run(options, output), n_ranks, time_limit(120));
  }
  /** To the end, with one warning; area and masses are exact. */
  void expect_repaired(const Result &result, const std::string &results) const
  {
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_GE(count(result.out, "has been repaired"), 1u) << result.out;
    EXPECT_EQ(count(result.out + result.err, "the mesh does not resolve the membrane since"), 1u);
    const TextTable table = read_text_table(path(results) + "/statistics.csv");
    for (const std::string name : {"area", "mass_f", "mass_total"})
      for (const std::string &value : table.at(name))
        EXPECT_NEAR(std::stod(value) / std::stod(table.at(name).front()), 1., 3e-12) << name;
  }
  std::string path(const std::string &results) const { return directory.file(results); }
};

TEST_F(Repair, WithoutItTheRunEnds)
{
  const Result result = result_of("run", "--set 'Membrane/Repair unresolved shapes=false'");
  EXPECT_EQ(result.exit_code, 2) << result.out;
  EXPECT_NE(result.err.find("'Smallest time step'"), std::string::npos) << result.err;
}

TEST_F(Repair, WithItTheRunGoesOnAlsoOnTwoRanks)
{
  expect_repaired(result_of("run", "", 2), "run");
}

TEST_F(Repair, AResumedRunRepairsInTheSameWay)
{
  namespace fs = std::filesystem;
  const Result uninterrupted = result_of("run");
  expect_repaired(uninterrupted, "run");
  std::vector<std::string> checkpoints;
  for (const auto &entry : fs::directory_iterator(path("run/checkpoint")))
    checkpoints.push_back(entry.path().filename().string());
  std::sort(checkpoints.begin(), checkpoints.end());
  ASSERT_GE(checkpoints.size(), 5u);
  // The first one is of the start. After 20 steps, before the first repair, and after 30.
  for (const unsigned int kept : {2u, 3u})
  {
    const std::string results = "resumed" + std::to_string(kept);
    fs::copy(path("run"), path(results), fs::copy_options::recursive);
    for (unsigned int i = kept + 1; i < checkpoints.size(); ++i)
      fs::remove_all(path(results) + "/checkpoint/" + checkpoints[i]);
    const Result resumed = result_of(results, "--resume");
    ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
    const unsigned int n_repairs = count(uninterrupted.out, "has been repaired");
    EXPECT_EQ(count(resumed.out, "has been repaired"), kept == 2 ? n_repairs : n_repairs - 1);
    Comparison().results(path("run"), path(results));
  }
}
