// SPDX-License-Identifier: LGPL-2.1-or-later
// Every parameter file that is shipped: it is valid, it computes, and its results are what scripts rely on.
#include <cmath>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <map>
#include <ostream>
#include <vector>

#include "support/run_program.h"
#include "support/statistics_table.h"

using namespace Gemmule::Testing;

namespace
{
/** A shipped file, and how to make a short, cheap run of it. */
struct ShippedCase
{
  std::string file;
  std::string settings;
  unsigned int least_steps;
  bool has_phases;
};

std::ostream &operator<<(std::ostream &out, const ShippedCase &shipped)
{
  return out << shipped.file;
}

const std::string short_paper_run =
    " --set 'End time=0.008' --set 'Output/Output times=' --set 'Mesh/Membrane level=5'"
    " --set 'Mesh/Phase boundary level=6'";

const std::vector<ShippedCase> shipped_cases = {
    {"examples/quick.prm", " --set 'End time=0.008'", 4, true},
    {"examples/bending.prm", " --set 'End time=0.004'", 4, true},
    {"examples/locomotion.prm", " --set 'End time=0.008' --set 'Mesh/Phase boundary level=5'", 4, true},
    {"examples/wrinkling.prm", " --set 'End time=0.008' --set 'Mesh/Membrane level=5'", 4, false},
    {"examples/budding.prm",
     " --set 'End time=0.008' --set 'Mesh/Membrane level=5' --set 'Mesh/Phase boundary level=5'", 4, true},
    {"examples/bud.prm", " --set 'End time=0.008' --set 'Mesh/Finest level=5'", 4, true},
    {"paper/unconstrained_ellipse.prm", short_paper_run, 4, true},
    {"paper/constrained_ellipse.prm", short_paper_run, 4, true},
    {"paper/constrained_elongated_ellipse.prm", short_paper_run, 4, true},
    {"verification/ellipse_constant_tension.prm", " --set 'End time=0.008' --set 'Output/Output times='", 4,
     false},
    {"verification/marangoni_circle.prm", "", 2, false},
    {"verification/static_circle.prm", " --set 'End time=0.03'", 3, false}};

/** Columns that users' scripts may rely on. */
const std::vector<std::string> contract_columns = {"time",
                                                   "step",
                                                   "time_step_size",
                                                   "cells",
                                                   "flow_dofs",
                                                   "surface_dofs",
                                                   "centroid_x",
                                                   "centroid_y",
                                                   "area",
                                                   "arclength",
                                                   "mass_f",
                                                   "mass_total",
                                                   "energy_surface",
                                                   "energy_phase",
                                                   "energy_constraint",
                                                   "energy_bending",
                                                   "energy_total",
                                                   "dissipation_viscous",
                                                   "dissipation_phase",
                                                   "max_velocity",
                                                   "tension_min",
                                                   "tension_max",
                                                   "f_total_min",
                                                   "f_total_max",
                                                   "composition_min",
                                                   "composition_max",
                                                   "phase_boundaries",
                                                   "components",
                                                   "curvature_max",
                                                   "deformation",
                                                   "area_correction",
                                                   "linear_iterations",
                                                   "wall_time"};

using Table = std::map<std::string, std::vector<double>>;

Table read_table(const std::string &path)
{
  Table table;
  for (const auto &[name, entries] : read_text_table(path))
    for (const auto &entry : entries)
      table[name].push_back(std::stod(entry));
  return table;
}

/** A dataset of the last group of interface.h5, read as any program that knows HDF5 does. */
std::vector<double> read_last(const std::string &path, const std::string &dataset, unsigned int &n_groups,
                              double &time)
{
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT_GE(file, 0);
  H5G_info_t info;
  H5Gget_info(file, &info);
  n_groups = info.nlinks;
  char group[20];
  std::snprintf(group, sizeof(group), "step_%05u", n_groups - 1);
  const hid_t attribute = H5Aopen_by_name(file, group, "time", H5P_DEFAULT, H5P_DEFAULT);
  EXPECT_GE(attribute, 0);
  H5Aread(attribute, H5T_NATIVE_DOUBLE, &time);
  H5Aclose(attribute);
  const hid_t data = H5Dopen2(file, (std::string(group) + "/" + dataset).c_str(), H5P_DEFAULT);
  EXPECT_GE(data, 0) << dataset;
  const hid_t space = H5Dget_space(data);
  std::vector<double> values(H5Sget_simple_extent_npoints(space));
  EXPECT_GE(H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Sclose(space);
  H5Dclose(data);
  H5Fclose(file);
  return values;
}

double weighted_sum(const std::vector<double> &weights, const std::vector<double> &values)
{
  EXPECT_EQ(weights.size(), values.size());
  double sum = 0.;
  for (unsigned int i = 0; i < weights.size(); ++i)
    sum += weights[i] * values[i];
  return sum;
}

std::string path_of(const std::string &file)
{
  return std::string(GEMMULE_SOURCE_DIRECTORY) + "/parameters/" + file;
}

void expect_sane_statistics(const Table &table, const ShippedCase &shipped)
{
  for (const auto &name : contract_columns)
    ASSERT_EQ(table.count(name), 1u) << name;
  const auto &time = table.at("time");
  const unsigned int n = time.size();
  ASSERT_GE(n, shipped.least_steps + 1);
  for (const auto &[name, values] : table)
    for (const double value : values)
      EXPECT_TRUE(std::isfinite(value)) << name;
  EXPECT_EQ(time[0], 0.);
  const auto conserved = [&](const std::string &name, const double tolerance)
  {
    for (const double value : table.at(name))
      EXPECT_NEAR(value, table.at(name)[0], tolerance * std::abs(table.at(name)[0])) << name;
  };
  conserved("area", 1e-10);
  conserved("mass_f", 1e-11);
  conserved("mass_total", 1e-11);
  for (unsigned int i = 0; i < n; ++i)
  {
    EXPECT_EQ(table.at("step")[i], i);
    if (i > 0)
    {
      EXPECT_NEAR(time[i] - time[i - 1], table.at("time_step_size")[i], 1e-14);
    }
    EXPECT_EQ(table.at("components")[i], 1.);
    EXPECT_GT(table.at("cells")[i], 64.);
    EXPECT_GT(table.at("flow_dofs")[i], table.at("cells")[i]);
    EXPECT_LE(table.at("tension_min")[i], table.at("tension_max")[i]);
    EXPECT_GT(table.at("arclength")[i], 2. * std::sqrt(M_PI * table.at("area")[i]) * (1. - 1e-6))
        << "shorter than the circle of the same area";
    EXPECT_NEAR(table.at("energy_total")[i],
                table.at("energy_surface")[i] + table.at("energy_phase")[i] +
                    table.at("energy_constraint")[i] + table.at("energy_bending")[i],
                1e-12);
    EXPECT_LT(table.at("max_velocity")[i], 10.);
    EXPECT_EQ(table.at("surface_dofs")[i] > 0., shipped.has_phases);
    EXPECT_EQ(table.at("f_total_min")[i] > 0.5, shipped.has_phases);
  }
}

void expect_membrane_agrees(const std::string &directory, const Table &table)
{
  const std::string path = directory + "/interface.h5";
  unsigned int n_groups = 0;
  double time = -1.;
  const auto weights = read_last(path, "weights", n_groups, time);
  EXPECT_GE(n_groups, 2u) << "start and end";
  EXPECT_DOUBLE_EQ(time, table.at("time").back());
  const std::vector<double> ones(weights.size(), 1.);
  EXPECT_NEAR(weighted_sum(weights, ones) / table.at("arclength").back(), 1., 1e-9);
  EXPECT_NEAR(weighted_sum(weights, read_last(path, "f", n_groups, time)), table.at("mass_f").back(), 1e-9);
  EXPECT_NEAR(weighted_sum(weights, read_last(path, "f_total", n_groups, time)),
              table.at("mass_total").back(), 1e-9);
  for (const auto *name : {"composition", "tension", "chemical_potential", "curvature"})
    EXPECT_EQ(read_last(path, name, n_groups, time).size(), weights.size()) << name;
  for (const auto *name : {"points", "velocity", "normal"})
    EXPECT_EQ(read_last(path, name, n_groups, time).size(), 2 * weights.size()) << name;
  EXPECT_EQ(read_last(path, "connectivity", n_groups, time).size(), 2 * weights.size()) << "one closed curve";
}
} // namespace

class ShippedCases : public testing::TestWithParam<ShippedCase>
{
protected:
  const TemporaryDirectory directory;
};

TEST_P(ShippedCases, PassesTheCheck)
{
  const Result result = run_gemmule(directory, path_of(GetParam().file) + " --check --output results");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("the parameters are valid"), std::string::npos) << result.out;
  EXPECT_FALSE(std::filesystem::exists(directory.path / "results")) << "a check writes nothing";
}

TEST_P(ShippedCases, Computes)
{
  const Result result =
      run_gemmule(directory, path_of(GetParam().file) + " --output results" + GetParam().settings);
  ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  const std::string results = directory.file("results");
  const Table table = read_table(results + "/statistics.csv");
  expect_sane_statistics(table, GetParam());
  if (HasFatalFailure())
    return;
  expect_membrane_agrees(results, table);
  for (const auto *name :
       {"parameters.prm", "log.txt", "interface.xdmf", "solution.xdmf", "solution-00000.h5"})
    EXPECT_TRUE(std::filesystem::exists(results + "/" + name)) << name;
  EXPECT_NE(directory.read("results/solution.xdmf").find("solution-00000.h5"), std::string::npos);
  EXPECT_NE(directory.read("results/log.txt").find("finished"), std::string::npos);

  // The recorded parameters describe the run that was made.
  const Result again = run_gemmule(directory, "results/parameters.prm --check");
  EXPECT_EQ(again.exit_code, 0) << again.err;
}

INSTANTIATE_TEST_SUITE_P(All, ShippedCases, testing::ValuesIn(shipped_cases),
                         [](const auto &info)
                         { return std::filesystem::path(info.param.file).stem().string(); });

TEST(ShippedFiles, AllOfThemAreTested)
{
  std::vector<std::string> present, tested;
  for (const auto &entry : std::filesystem::recursive_directory_iterator(path_of("")))
    if (entry.path().extension() == ".prm")
      present.push_back(std::filesystem::relative(entry.path(), path_of("")).string());
  for (const auto &shipped : shipped_cases)
    tested.push_back(shipped.file);
  std::sort(present.begin(), present.end());
  std::sort(tested.begin(), tested.end());
  EXPECT_EQ(present, tested);
}

TEST(TwoProcesses, GiveTheStatisticsOfOne)
{
  const TemporaryDirectory directory;
  const std::string arguments = path_of("examples/quick.prm") + " --set 'End time=0.008'";
  const Result one = run_gemmule(directory, arguments + " --output one");
  const Result two = run_gemmule(directory, arguments + " --output two", 2);
  ASSERT_EQ(one.exit_code, 0) << one.err;
  ASSERT_EQ(two.exit_code, 0) << two.err;
  const Table a = read_table(directory.file("one/statistics.csv"));
  const Table b = read_table(directory.file("two/statistics.csv"));
  ASSERT_EQ(a.size(), b.size());
  for (const auto &[name, values] : a)
  {
    ASSERT_EQ(values.size(), b.at(name).size());
    for (unsigned int i = 0; i < values.size() && name != "wall_time"; ++i)
      EXPECT_NEAR(b.at(name)[i], values[i], 1e-8 * std::max(1., std::abs(values[i])))
          << name << ", row " << i;
  }
  unsigned int n_groups = 0;
  double time = 0.;
  const auto points_one = read_last(directory.file("one/interface.h5"), "points", n_groups, time);
  const auto points_two = read_last(directory.file("two/interface.h5"), "points", n_groups, time);
  ASSERT_EQ(points_one.size(), points_two.size());
  for (unsigned int i = 0; i < points_one.size(); ++i)
    EXPECT_NEAR(points_one[i], points_two[i], 1e-8);
}

TEST(FailingRun, EndsWithCodeTwoAndKeepsTheLastAcceptedStep)
{
  const TemporaryDirectory directory;
  // A tolerance that no step can meet, and hardly any room to shrink.
  const auto result =
      run_gemmule(directory, "'" + std::string(GEMMULE_SOURCE_DIRECTORY) +
                                 "/parameters/verification/ellipse_constant_tension.prm' --output out "
                                 "--set 'Time stepping/Tolerance=1e-14' "
                                 "--set 'Time stepping/Smallest time step=9e-4'");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("Smallest time step"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("times the tolerance"), std::string::npos) << result.err;
  EXPECT_TRUE(std::filesystem::exists(directory.path / "out" / "interface.h5"));
  EXPECT_NE(directory.read("out/log.txt").find("stopped at t = 0"), std::string::npos);
  EXPECT_NE(directory.read("out/statistics.csv").find("\n0,0,"), std::string::npos);
}
