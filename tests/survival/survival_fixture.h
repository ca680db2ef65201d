// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/output/hdf5_file.h>
#include <gemmule/output/statistics.h>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "support/running_program.h"
#include "support/statistics_table.h"
#include "support/test_size.h"

namespace Gemmule::Testing
{
/**
 * Two phases that the flow carries through the box, so that the mesh is refined and coarsened, with steps
 * that grow and output at other times than theirs; about forty steps of a tenth of a second.
 */
inline const std::string small_case = R"(
set End time = 0.15
subsection Domain
  set Boundary velocity = 1; 0
end
subsection Membrane
  set Level set             = (x+0.1)^2+2*y^2-0.25
  set Cahn number           = 0.1
  set Initial concentration = 0.5+0.4*tanh(6*x)
end
subsection Mesh
  set Bulk level           = 3
  set Membrane level       = 4
  set Phase boundary level = 5
  set Remeshing interval   = 3
end
subsection Time stepping
  set Largest time step = 0.01
end
subsection Output
  set Field output interval     = 0.04
  set Interface output interval = 0.02
  set Progress line             = false
end
)";

inline std::size_t n_rows(const std::string &results)
{
  std::ifstream file(results + "/statistics.csv");
  const std::size_t n_lines = std::count(std::istreambuf_iterator<char>(file), {}, '\n');
  return n_lines > 0 ? n_lines - 1 : 0;
}

inline std::set<std::string> field_files(const std::string &results)
{
  std::set<std::string> names;
  for (const auto &entry : std::filesystem::directory_iterator(results))
    if (entry.path().filename().string().compare(0, 9, "solution-") == 0)
      names.insert(entry.path().filename().string());
  return names;
}

/** A comparison of the numbers of two runs: exact, or to a relative tolerance (against at least one). */
class Comparison
{
public:
  explicit Comparison(const double tolerance = 0.) : tolerance(tolerance) {}

  void results(const std::string &expected, const std::string &found) const
  {
    statistics(expected, found);
    membrane(expected + "/interface.h5", found + "/interface.h5");
    ASSERT_EQ(field_files(expected), field_files(found));
    for (const std::string &name : field_files(expected))
      fields(expected + "/" + name, found + "/" + name);
  }

  void statistics(const std::string &expected, const std::string &found) const
  {
    const TextTable a = read_text_table(expected + "/statistics.csv"),
                    b = read_text_table(found + "/statistics.csv");
    ASSERT_EQ(a.size(), statistics_columns().size());
    ASSERT_EQ(a.size(), b.size());
    for (const auto &[name, values] : a)
    {
      ASSERT_EQ(values.size(), b.at(name).size()) << "rows of " << found;
      if (name == "wall_time")
        continue;
      if (tolerance == 0.)
      {
        EXPECT_EQ(values, b.at(name)) << name;
        continue;
      }
      std::vector<double> x, y;
      for (std::size_t i = 0; i < values.size(); ++i)
      {
        x.push_back(std::stod(values[i]));
        y.push_back(std::stod(b.at(name)[i]));
      }
      numbers(x, y, name);
    }
    // Wall time is that of all runs together: it never goes back.
    const auto &wall_time = b.at("wall_time");
    for (std::size_t i = 1; i < wall_time.size(); ++i)
      EXPECT_GE(std::stod(wall_time[i]), std::stod(wall_time[i - 1]));
  }

  void membrane(const std::string &expected, const std::string &found) const
  {
    const Hdf5File a(expected, Hdf5File::Mode::read), b(found, Hdf5File::Mode::read);
    ASSERT_EQ(a.members(), b.members());
    const auto integrals = [](const Hdf5File &file, const std::string &group)
    {
      const auto weights = file.read(group + "/weights");
      std::vector<double> sums;
      for (const std::string name : {"points", "f", "f_total", "tension", "chemical_potential", "velocity"})
      {
        const auto values = file.read(group + "/" + name);
        const std::size_t n_components = values.size() / weights.size();
        for (std::size_t c = 0; c < n_components; ++c)
        {
          sums.push_back(0.);
          for (std::size_t i = 0; i < weights.size(); ++i)
            sums.back() += weights[i] * values[n_components * i + c];
        }
      }
      return sums;
    };
    for (const std::string &group : a.members())
    {
      // Round-off decides where the list of points begins, and how a cell is cut that hardly is.
      if (tolerance > 0.)
      {
        numbers(integrals(a, group), integrals(b, group), group + " integrals");
        numbers({a.number_attribute(group, "time")}, {b.number_attribute(group, "time")}, group + " time");
        continue;
      }
      numbers({a.number_attribute(group, "time")}, {b.number_attribute(group, "time")}, group + " time");
      for (const std::string name : {"points", "f", "f_total", "composition", "tension", "chemical_potential",
                                     "velocity", "normal", "curvature", "weights", "connectivity"})
        numbers(a.read(group + "/" + name), b.read(group + "/" + name), group + "/" + name);
    }
  }

  void fields(const std::string &expected, const std::string &found) const
  {
    const Hdf5File a(expected, Hdf5File::Mode::read), b(found, Hdf5File::Mode::read);
    ASSERT_EQ(a.members(), b.members());
    numbers({a.number_attribute("/", "time")}, {b.number_attribute("/", "time")}, found + " time");
    // Another number of ranks makes the same mesh in another order.
    if (tolerance == 0.)
      for (const std::string &name : a.members())
        numbers(a.read(name), b.read(name), found + ": " + name);
  }

private:
  void numbers(const std::vector<double> &a, const std::vector<double> &b, const std::string &what) const
  {
    ASSERT_EQ(a.size(), b.size()) << what;
    double largest = 0.;
    bool same = true;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
      const double difference = std::abs(a[i] - b[i]) / std::max(1., std::abs(a[i]));
      ASSERT_TRUE(std::isfinite(difference)) << what << ": " << a[i] << " and " << b[i];
      largest = std::max(largest, difference);
      same = same && a[i] == b[i];
    }
    if (tolerance == 0.)
      EXPECT_TRUE(same) << what << " differs by up to " << largest;
    else
      EXPECT_LE(largest, tolerance) << what;
  }

  const double tolerance;
};

/** How often @p part occurs in @p text. */
inline std::size_t count(const std::string &text, const std::string &part)
{
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++n;
  return n;
}

/** Runs the small case to its end, into reference/ of @p directory, and writes down how many seconds it
 * takes. */
inline void compute_reference(const Directory &directory)
{
  const auto start = std::chrono::steady_clock::now();
  directory.write("case.prm", small_case);
  const Result result = run_gemmule(directory, "case.prm --output reference");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  ASSERT_GE(n_rows(directory.file("reference")), 30u) << "the run has to be long enough to be interrupted";
  ASSERT_GE(field_files(directory.file("reference")).size(), 4u);
  const std::chrono::duration<double> duration = std::chrono::steady_clock::now() - start;
  directory.write("seconds", std::to_string(duration.count()));
}

/** A directory with a parameter file, case.prm, for runs of it whose results go to the folder run/. */
class RunsOfACase : public testing::Test
{
protected:
  explicit RunsOfACase(const std::string &parameters) { directory.write("case.prm", parameters); }

  /** Arguments of the run under test. */
  std::string run(const std::string &options = "", const std::string &output = "run") const
  {
    return "case.prm --output " + output + " " + options;
  }
  std::string results() const { return directory.file("run"); }
  std::string log() const { return directory.read("run/log.txt"); }
  /** What a RunningProgram has written to the standard error. */
  std::string errors() const { return directory.read(".stderr"); }

  const TemporaryDirectory directory;
};

/**
 * Runs of the small case, and the results of one that nothing interrupts, shared by all tests. They are in
 * the directory that the environment variable GEMMULE_SURVIVAL_REFERENCE names, where
 * UninterruptedRun.IsComputed puts them: ctest runs that test first, and each test in a process of its own.
 * Without the variable they are computed by the process.
 */
class Survival : public RunsOfACase
{
protected:
  Survival() : RunsOfACase(small_case) {}
  static void SetUpTestSuite()
  {
    const char *const prepared = std::getenv("GEMMULE_SURVIVAL_REFERENCE");
    if (prepared == nullptr && own_reference == nullptr)
    {
      own_reference = std::make_unique<TemporaryDirectory>();
      compute_reference(*own_reference);
    }
    reference_directory.emplace(prepared != nullptr ? prepared : own_reference->path);
    ASSERT_TRUE(std::ifstream(reference_directory->file("seconds")) >> reference_seconds)
        << reference_directory->path << " does not hold the results of UninterruptedRun.IsComputed";
  }
  static std::string reference() { return reference_directory->file("reference"); }

  /** Numbers of the checkpoints on disk that say that they are complete. */
  std::vector<std::string> complete_checkpoints() const
  {
    std::vector<std::string> found;
    std::error_code error;
    for (const auto &entry : std::filesystem::directory_iterator(results() + "/checkpoint", error))
      if (std::filesystem::exists(entry.path() / "metadata.txt", error))
        found.push_back(entry.path().string());
    std::sort(found.begin(), found.end());
    return found;
  }
  /** Runs to the end what is in the directory. */
  void resume_to_the_end(const std::string &options = "", const unsigned int n_processes = 1)
  {
    const Result result = run_gemmule(directory, run("--resume " + options), n_processes);
    ASSERT_EQ(result.exit_code, 0) << result.out << result.err;
  }

  static inline std::optional<Directory> reference_directory;
  static inline double reference_seconds = 0.;

private:
  static inline std::unique_ptr<TemporaryDirectory> own_reference;
};
} // namespace Gemmule::Testing
