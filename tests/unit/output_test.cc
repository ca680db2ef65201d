// What the output module writes is read back, as a user's script, a resumed run or ParaView would.
#include <gemmule/output/field_output.h>
#include <gemmule/output/hdf5_file.h>
#include <gemmule/output/interface_output.h>
#include <gemmule/output/output_directory.h>
#include <gemmule/output/rank_zero.h>
#include <gemmule/output/run_log.h>
#include <gemmule/output/statistics.h>
#include <gemmule/parameters/errors.h>
#include <gemmule/version.h>

#include <deal.II/base/function_lib.h>
#include <deal.II/base/numbers.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/lac/vector.h>
#include <deal.II/numerics/data_out.h>
#include <deal.II/numerics/vector_tools_interpolate.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sstream>
#include <sys/resource.h>

using namespace Gemmule;

namespace
{
/** A directory of its own for each test, the same on all ranks, removed at the end. */
class OutputTest : public ::testing::Test
{
protected:
  void SetUp() override
  {
    const auto *test = ::testing::UnitTest::GetInstance()->current_test_info();
    directory = "output-test-" + std::string(test->test_suite_name()) + "-" + test->name() + "-" +
                std::to_string(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
    on_rank_zero(MPI_COMM_WORLD,
                 [&]()
                 {
                   std::filesystem::remove_all(directory);
                   std::filesystem::create_directories(directory);
                 });
  }

  void TearDown() override
  {
    MPI_Barrier(MPI_COMM_WORLD); // others may still be looking at the files
    on_rank_zero(MPI_COMM_WORLD, [&]() { std::filesystem::remove_all(directory); });
  }

  std::string path(const std::string &name) const { return directory + "/" + name; }

  std::string content(const std::string &name) const
  {
    std::ifstream file(path(name));
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  std::vector<std::string> lines(const std::string &name) const
  {
    std::istringstream text(content(name));
    std::vector<std::string> list;
    for (std::string line; std::getline(text, line);)
      list.push_back(line);
    return list;
  }

  std::string directory;
};

class ParallelOutputTest : public OutputTest
{
};

/** Lets no file grow beyond a size while it lives, which is what a full disk does to a program. */
class FullDisk
{
public:
  explicit FullDisk(const rlim_t largest_size)
  {
    getrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit now = before;
    now.rlim_cur = largest_size;
    setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FullDisk() { setrlimit(RLIMIT_FSIZE, &before); }

private:
  rlimit before;
};

/** Points on a circle of radius @p radius with equal weights, f = 1 + cos(angle). */
InterfaceSamples<2> circle(const double time, const double radius, const unsigned int n = 64)
{
  InterfaceSamples<2> samples;
  samples.time = time;
  for (unsigned int i = 0; i < n; ++i)
  {
    const double angle = 2. * dealii::numbers::PI * i / n;
    const dealii::Tensor<1, 2> normal({std::cos(angle), std::sin(angle)});
    samples.points.emplace_back(radius * normal);
    samples.normal.push_back(normal);
    samples.velocity.emplace_back(dealii::Tensor<1, 2>({-normal[1], 3. * normal[0]}));
    samples.f.push_back(1. + normal[0]);
    samples.f_total.push_back(2.);
    samples.composition.push_back(0.5 * (1. + normal[0]));
    samples.tension.push_back(0.25 * i);
    samples.chemical_potential.push_back(-0.5 * i);
    samples.curvature.push_back(1. / radius);
    samples.weights.push_back(2. * dealii::numbers::PI * radius / n);
    samples.connectivity.push_back({{i, (i + 1) % n}});
  }
  return samples;
}

std::ptrdiff_t count(const char character, const std::string &text)
{
  return std::count(text.begin(), text.end(), character);
}

std::string message_of(const std::function<void()> &action)
{
  try
  {
    action();
  }
  catch (const std::exception &error)
  {
    return error.what();
  }
  return "nothing thrown";
}
} // namespace

TEST_F(OutputTest, StatisticsHeaderIsTheContract)
{
  StatisticsWriter writer(directory, MPI_COMM_SELF);
  const std::string contract =
      "time,step,time_step_size,cells,flow_dofs,surface_dofs,centroid_x,centroid_y,area,arclength,mass_f,"
      "mass_total,energy_surface,energy_phase,energy_constraint,energy_bending,energy_total,"
      "dissipation_viscous,dissipation_phase,max_velocity,tension_min,tension_max,f_total_min,f_total_max,"
      "composition_min,composition_max,phase_boundaries,components,curvature_max,deformation,"
      "area_correction,linear_iterations,wall_time";
  ASSERT_EQ(lines("statistics.csv").size(), 1u);
  EXPECT_EQ(lines("statistics.csv")[0].substr(0, contract.size() + 1), contract + ",");
}

TEST_F(OutputTest, StatisticsRowsReproduceEveryDigit)
{
  StatisticsRow row;
  row.time = 0.1;
  row.step = 7;
  row.cells = 12345678901ul;
  row.centroid_x = -1. / 3.;
  row.wall_time = 1e-300;
  row.phase_boundaries = 4;
  row.time_error_composition = dealii::numbers::PI;
  StatisticsWriter writer(directory, MPI_COMM_SELF);
  writer.write(row);

  // The writer is still open: the row has to be on disk nevertheless.
  const std::vector<std::string> names = statistics_columns();
  ASSERT_EQ(lines("statistics.csv").size(), 2u);
  std::istringstream line(lines("statistics.csv")[1]);
  std::map<std::string, std::string> values;
  for (const std::string &name : names)
    ASSERT_TRUE(std::getline(line, values[name], ','));
  EXPECT_EQ(std::stod(values["time"]), row.time);
  EXPECT_EQ(values["step"], "7");
  EXPECT_EQ(values["cells"], "12345678901");
  EXPECT_EQ(std::stod(values["centroid_x"]), row.centroid_x);
  EXPECT_EQ(std::stod(values["wall_time"]), row.wall_time);
  EXPECT_EQ(values["phase_boundaries"], "4");
  EXPECT_EQ(std::stod(values["time_error_composition"]), row.time_error_composition);
}

TEST_F(OutputTest, StatisticsOfAResumedRunAreCutOff)
{
  {
    StatisticsWriter writer(directory, MPI_COMM_SELF);
    StatisticsRow row;
    for (row.step = 1; row.step <= 5; ++row.step)
    {
      row.time = 0.1 * row.step;
      writer.write(row);
    }
  }
  const std::vector<std::string> before = lines("statistics.csv");
  std::ofstream(path("statistics.csv"), std::ios::app) << "0.2,6,0.1"; // what a kill leaves

  StatisticsWriter resumed(directory, MPI_COMM_SELF, 0.1 * 3);
  EXPECT_EQ(lines("statistics.csv"), std::vector<std::string>(before.begin(), before.begin() + 4));
  StatisticsRow row;
  row.time = 0.35;
  resumed.write(row);
  EXPECT_EQ(lines("statistics.csv").size(), 5u);
  EXPECT_EQ(lines("statistics.csv").back().substr(0, 4), "0.34"); // 0.34999999999999998
}

TEST_F(OutputTest, StatisticsOfAnotherVersionAreNotMixed)
{
  std::ofstream(path("statistics.csv")) << "time,step\n0,0\n";
  EXPECT_THROW(StatisticsWriter(directory, MPI_COMM_SELF, 1.), UserError);
  EXPECT_EQ(lines("statistics.csv").size(), 2u);
  StatisticsWriter fresh(directory, MPI_COMM_SELF);
  EXPECT_EQ(lines("statistics.csv").size(), 1u);
}

TEST_F(ParallelOutputTest, StatisticsFailureReachesAllRanks)
{
  StatisticsWriter writer(directory, MPI_COMM_WORLD);
  const FullDisk full_disk(1000);
  const std::string message = message_of(
      [&]()
      {
        for (unsigned int i = 0; i < 100; ++i)
          writer.write(StatisticsRow());
      });
  EXPECT_NE(message.find(path("statistics.csv")), std::string::npos) << message;
  EXPECT_NE(message.find("disk full"), std::string::npos) << message;
  EXPECT_NE(message.find("--resume"), std::string::npos) << message;
}

TEST_F(OutputTest, InterfaceIsReadBack)
{
  InterfaceWriter<2> writer(directory, MPI_COMM_SELF, "gemmule case.prm");
  writer.write(circle(0., 0.5));
  writer.write(circle(0.25, 0.4, 32));

  const Hdf5File file(path("interface.h5"), Hdf5File::Mode::read);
  EXPECT_EQ(file.members(), (std::vector<std::string>{"step_00000", "step_00001"}));
  EXPECT_EQ(file.number_attribute("/", "schema_version"), 1.);
  EXPECT_EQ(file.text_attribute("/", "gemmule_version"), GEMMULE_VERSION);
  EXPECT_EQ(file.text_attribute("/", "git_revision"), GEMMULE_GIT_REVISION);
  EXPECT_EQ(file.text_attribute("/", "command_line"), "gemmule case.prm");
  EXPECT_EQ(file.number_attribute("step_00000", "time"), 0.);
  EXPECT_EQ(file.number_attribute("step_00001", "time"), 0.25);

  EXPECT_EQ(file.extent("step_00000/points"), (std::vector<std::size_t>{64, 2}));
  EXPECT_EQ(file.extent("step_00001/connectivity"), (std::vector<std::size_t>{32, 2}));
  EXPECT_EQ(file.extent("step_00001/f"), (std::vector<std::size_t>{32}));

  double arclength = 0., mass_f = 0., mass_total = 0.;
  const std::vector<double> weights = file.read("step_00000/weights");
  const std::vector<double> f = file.read("step_00000/f");
  const std::vector<double> f_total = file.read("step_00000/f_total");
  for (unsigned int i = 0; i < weights.size(); ++i)
  {
    arclength += weights[i];
    mass_f += weights[i] * f[i];
    mass_total += weights[i] * f_total[i];
  }
  EXPECT_NEAR(arclength, dealii::numbers::PI, 1e-14);
  EXPECT_NEAR(mass_f, dealii::numbers::PI, 1e-14);
  EXPECT_NEAR(mass_total, 2. * dealii::numbers::PI, 1e-14);

  const InterfaceSamples<2> second = circle(0.25, 0.4, 32);
  const std::vector<double> velocity = file.read("step_00001/velocity");
  const std::vector<double> normal = file.read("step_00001/normal");
  EXPECT_EQ(velocity[2 * 5 + 1], second.velocity[5][1]);
  EXPECT_EQ(normal[2 * 5], second.normal[5][0]);
  EXPECT_EQ(file.read("step_00001/points")[2 * 31 + 1], second.points[31][1]);
  EXPECT_EQ(file.read("step_00001/connectivity")[2 * 31 + 1], 0.);
  EXPECT_EQ(file.read("step_00001/tension"), second.tension);
  EXPECT_EQ(file.read("step_00001/chemical_potential"), second.chemical_potential);
  EXPECT_EQ(file.read("step_00001/composition"), second.composition);
  EXPECT_EQ(file.read("step_00001/curvature"), second.curvature);
}

TEST_F(OutputTest, InterfaceXdmfListsEveryTimeAndField)
{
  InterfaceWriter<2> writer(directory, MPI_COMM_SELF, "");
  writer.write(circle(0., 0.5));
  writer.write(circle(0.25, 0.4));
  const std::string text = content("interface.xdmf");
  for (const char *part :
       {"Time Value=\"0\"", "Time Value=\"0.25\"", "TopologyType=\"Polyline\"", "Name=\"composition\"",
        "Name=\"tension\"", "Name=\"velocity\"", "interface.h5:/step_00001/connectivity"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

TEST_F(OutputTest, InterfaceOfAResumedRunIsCutOff)
{
  {
    InterfaceWriter<2> writer(directory, MPI_COMM_SELF, "first");
    for (const double time : {0., 0.1, 0.2, 0.3})
      writer.write(circle(time, 0.5));
    Hdf5File file(path("interface.h5"), Hdf5File::Mode::modify);
    file.create_group("step_00004"); // what a kill leaves
  }
  InterfaceWriter<2> resumed(directory, MPI_COMM_SELF, "second", 0.1);
  EXPECT_EQ(content("interface.xdmf").find("step_00002"), std::string::npos);
  resumed.write(circle(0.15, 0.3));

  const Hdf5File file(path("interface.h5"), Hdf5File::Mode::read);
  EXPECT_EQ(file.members(), (std::vector<std::string>{"step_00000", "step_00001", "step_00002"}));
  EXPECT_EQ(file.number_attribute("step_00002", "time"), 0.15);
  EXPECT_EQ(file.text_attribute("/", "command_line"), "first");
  EXPECT_NE(content("interface.xdmf").find("step_00002"), std::string::npos);
}

TEST_F(OutputTest, InterfaceOnAFullDiskFailsReadably)
{
  InterfaceWriter<2> writer(directory, MPI_COMM_SELF, "");
  writer.write(circle(0., 0.5));
  const std::string message = message_of(
      [&]()
      {
        const FullDisk full_disk(std::filesystem::file_size(path("interface.h5")) + 4096);
        writer.write(circle(0.1, 0.5, 5000));
      });
  EXPECT_NE(message.find("interface.h5"), std::string::npos) << message;
  EXPECT_NE(message.find("disk full"), std::string::npos) << message;

  // The file is unharmed, and the run goes on when there is room again.
  EXPECT_EQ(Hdf5File(path("interface.h5"), Hdf5File::Mode::read).members().size(), 1u);
  writer.write(circle(0.1, 0.5, 5000));
  EXPECT_EQ(Hdf5File(path("interface.h5"), Hdf5File::Mode::read).members().size(), 2u);
}

TEST_F(OutputTest, InterfaceOfADamagedFileFailsReadably)
{
  std::ofstream(path("interface.h5")) << "This is no HDF5 file.";
  const std::string message = message_of([&]() { InterfaceWriter<2>(directory, MPI_COMM_SELF, "", 1.); });
  EXPECT_NE(message.find("interface.h5"), std::string::npos) << message;
  EXPECT_NE(message.find("damaged"), std::string::npos) << message;
}

TEST_F(ParallelOutputTest, FieldsAreReadBackAndResumed)
{
  dealii::parallel::distributed::Triangulation<2> triangulation(MPI_COMM_WORLD);
  dealii::GridGenerator::hyper_cube(triangulation, -1., 1.);
  triangulation.refine_global(3);
  const dealii::FE_Q<2> element(1);
  dealii::DoFHandler<2> dof_handler(triangulation);
  dof_handler.distribute_dofs(element);
  dealii::Vector<double> values(dof_handler.n_dofs());
  dealii::VectorTools::interpolate(dof_handler,
                                   dealii::Functions::Monomial<2>(dealii::Tensor<1, 2>({1., 0.})), values);
  dealii::DataOut<2> data;
  data.attach_dof_handler(dof_handler);
  data.add_data_vector(values, "level_set");
  data.build_patches();
  {
    FieldWriter<2> writer(directory, MPI_COMM_WORLD);
    for (const double time : {0., 0.5, 1.})
      writer.write(data, time);
  }
  on_rank_zero(MPI_COMM_WORLD,
               [&]()
               {
                 const Hdf5File file(path("solution-00001.h5"), Hdf5File::Mode::read);
                 EXPECT_EQ(file.number_attribute("/", "time"), 0.5);
                 EXPECT_EQ(file.extent("cells"), (std::vector<std::size_t>{64, 4}));
                 const std::vector<double> nodes = file.read("nodes");
                 const std::vector<double> level_set = file.read("level_set");
                 ASSERT_EQ(nodes.size(), 2 * 4 * 64u);
                 for (unsigned int i = 0; i < level_set.size(); ++i)
                   EXPECT_NEAR(level_set[i], nodes[2 * i], 1e-15);
               });

  const std::string complete = content("solution.xdmf");
  FieldWriter<2> resumed(directory, MPI_COMM_WORLD, 0.5);
  EXPECT_EQ(std::filesystem::exists(path("solution-00001.h5")), true);
  EXPECT_EQ(std::filesystem::exists(path("solution-00002.h5")), false);
  resumed.write(data, 1.);
  // The entries of the earlier files were read from them, and must be what was said when they were written.
  EXPECT_EQ(content("solution.xdmf"), complete);
  EXPECT_NE(complete.find("solution-00002.h5:/level_set"), std::string::npos);
}

TEST_F(ParallelOutputTest, FieldsThatCannotBeWrittenFailOnAllRanks)
{
  dealii::parallel::distributed::Triangulation<2> triangulation(MPI_COMM_WORLD);
  dealii::GridGenerator::hyper_cube(triangulation, -1., 1.);
  triangulation.refine_global(2);
  dealii::DataOut<2> data;
  data.attach_triangulation(triangulation);
  dealii::Vector<float> values(triangulation.n_active_cells());
  data.add_data_vector(values, "level", dealii::DataOut<2>::type_cell_data);
  data.build_patches();
  FieldWriter<2> writer(path("missing"), MPI_COMM_WORLD);
  const std::string message = message_of([&]() { writer.write(data, 0.); });
  EXPECT_NE(message.find("missing/solution-00000.h5"), std::string::npos) << message;

  FieldWriter<2> on_full_disk(directory, MPI_COMM_WORLD);
  const FullDisk full_disk(1000);
  const std::string disk_message = message_of([&]() { on_full_disk.write(data, 0.); });
  EXPECT_NE(disk_message.find("disk full"), std::string::npos) << disk_message;
}

TEST_F(ParallelOutputTest, DirectoryIsCreatedAndCleared)
{
  const std::string results = path("deep/results");
  {
    const OutputDirectory output(results, MPI_COMM_WORLD);
    output.write_parameters("set End time = 1\n");
    EXPECT_EQ(content("deep/results/parameters.prm"), "set End time = 1\n");
    EXPECT_EQ(output.file("log.txt"), results + "/log.txt");
  }
  const std::vector<std::string> ours = {"statistics.csv",  "interface.h5",      "interface.xdmf",
                                         "solution.xdmf",   "solution-00012.h5", "log.txt",
                                         "checkpoint/state"};
  const std::vector<std::string> foreign = {"notes.txt", "solution-best.h5", "checkpoint-of-mine"};
  on_rank_zero(MPI_COMM_WORLD,
               [&]()
               {
                 std::filesystem::create_directory(results + "/checkpoint");
                 for (const auto &names : {ours, foreign})
                   for (const std::string &name : names)
                     std::ofstream(results + "/" + name) << "content";
               });
  {
    const OutputDirectory resumed(results, MPI_COMM_WORLD, /*resume =*/true);
    for (const std::string &name : ours)
      EXPECT_TRUE(std::filesystem::exists(results + "/" + name)) << name;
    MPI_Barrier(MPI_COMM_WORLD);
  }
  const OutputDirectory again(results, MPI_COMM_WORLD);
  for (const std::string &name : ours)
    EXPECT_EQ(std::filesystem::exists(results + "/" + name), name == "log.txt") << name;
  for (const std::string &name : foreign)
    EXPECT_TRUE(std::filesystem::exists(results + "/" + name)) << name;
}

TEST_F(ParallelOutputTest, DirectoryThatCannotBeCreated)
{
  on_rank_zero(MPI_COMM_WORLD, [&]() { std::ofstream(path("file")) << "in the way"; });
  for (const std::string &impossible : std::vector<std::string>{path("file"), path("file/results")})
  {
    EXPECT_THROW(OutputDirectory(impossible, MPI_COMM_WORLD), UserError);
    const std::string message = message_of([&]() { OutputDirectory(impossible, MPI_COMM_WORLD); });
    EXPECT_NE(message.find(impossible), std::string::npos) << message;
    EXPECT_NE(message.find("--output"), std::string::npos) << message;
  }
}

TEST_F(OutputTest, DirectoryOnAFullDisk)
{
  const FullDisk full_disk(4);
  EXPECT_THROW(OutputDirectory(directory, MPI_COMM_SELF), UserError);
}

TEST_F(OutputTest, LogGoesToFileAndConsole)
{
  std::ostringstream console;
  {
    RunLog log(directory, MPI_COMM_SELF, false, {console, false, []() { return 0.; }});
    log.info("Reading case.prm");
    log.warn_once("negative tension", "the tension is negative");
    log.warn_once("negative tension", "the tension is negative again");
    log.warn("second");
  }
  EXPECT_EQ(console.str(), "Reading case.prm\nwarning: the tension is negative\nwarning: second\n");
  EXPECT_EQ(content("log.txt"), console.str());
  {
    RunLog resumed(directory, MPI_COMM_SELF, /*append =*/true, {console, false, []() { return 0.; }});
    resumed.info("Resumed");
  }
  EXPECT_EQ(lines("log.txt").size(), 4u);
}

TEST_F(OutputTest, ProgressIsOneLineOnATerminal)
{
  std::ostringstream console;
  double now = 0.;
  RunLog log(directory, MPI_COMM_SELF, false, {console, true, [&now]() { return now; }});
  log.progress(0., 2., 0, 0.1);
  now = 10.;
  log.progress(0.5, 2., 5, 0.1);
  EXPECT_EQ(count('\n', console.str()), 0);
  EXPECT_EQ(count('\r', console.str()), 2);
  EXPECT_NE(console.str().find(" 25 %"), std::string::npos) << console.str();
  EXPECT_NE(console.str().find("30 s left"), std::string::npos) << console.str();
  log.info("message");
  EXPECT_NE(console.str().find("left\nmessage\n"), std::string::npos) << console.str();
  EXPECT_EQ(content("log.txt"), "message\n");
}

TEST_F(OutputTest, ProgressIsRareElsewhere)
{
  std::ostringstream console;
  double now = 0.;
  RunLog log(directory, MPI_COMM_SELF, false, {console, false, [&now]() { return now; }});
  for (unsigned int step = 0; step <= 100; ++step, now += 0.5)
    log.progress(0.01 * step, 1., step, 0.01);
  // At 0, 10, 20, 30, 40 and 50 seconds, the last of which is the end.
  EXPECT_EQ(count('\n', console.str()), 6) << console.str();
  EXPECT_EQ(count('\r', console.str()), 0);
  EXPECT_NE(console.str().find("finished"), std::string::npos);
}

TEST(ProgressFormat, Durations)
{
  EXPECT_EQ(format_duration(0.4), "0 s");
  EXPECT_EQ(format_duration(59.4), "59 s");
  EXPECT_EQ(format_duration(59.6), "1 min 00 s");
  EXPECT_EQ(format_duration(185.), "3 min 05 s");
  EXPECT_EQ(format_duration(2. * 3600. + 7. * 60. + 5.), "2 h 07 min");
  EXPECT_EQ(format_duration(INFINITY), "?");
}

TEST(ProgressFormat, Line)
{
  EXPECT_EQ(format_progress(0.1234, 0.5, 42, 1.25e-3, 185.),
            " 24 %  time 0.1234 of 0.5, step 42, step size 1.25e-03, 3 min 05 s left");
  // Nearly finished is not finished.
  EXPECT_EQ(format_progress(0.9999, 1., 1, 0.1, 1.).substr(0, 5), " 99 %");
}
