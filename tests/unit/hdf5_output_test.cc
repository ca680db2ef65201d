// SPDX-License-Identifier: LGPL-2.1-or-later
// What goes to HDF5 and XDMF is read back, as a user's script, a resumed run or ParaView would.
#include <gemmule/base/exceptions.h>
#include <gemmule/output/field_output.h>
#include <gemmule/output/hdf5_file.h>
#include <gemmule/output/interface_output.h>
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
#include <cstdlib>
#include <limits>

#include "support/output_test.h"

using namespace Gemmule;

namespace
{
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

/** A number on each cell of a small mesh, ready to be written. */
struct CellData
{
  explicit CellData(const MPI_Comm communicator = MPI_COMM_WORLD, const unsigned int n_refinements = 2)
      : triangulation(communicator)
  {
    dealii::GridGenerator::hyper_cube(triangulation, -1., 1.);
    triangulation.refine_global(n_refinements);
    data.attach_triangulation(triangulation);
    values.reinit(triangulation.n_active_cells());
    for (const auto &cell : triangulation.active_cell_iterators())
      values[cell->active_cell_index()] = 1.f + static_cast<float>(cell->center()[0]);
    data.add_data_vector(values, "level", dealii::DataOut<2>::type_cell_data);
    data.build_patches();
  }

  dealii::parallel::distributed::Triangulation<2> triangulation;
  dealii::Vector<float> values;
  dealii::DataOut<2> data;
};

/** What the text says between `Time Value="` and the next quotation mark, in order. */
std::vector<std::string> times_of(const std::string &xdmf)
{
  const std::string before = "Time Value=\"";
  std::vector<std::string> times;
  for (auto at = xdmf.find(before); at != std::string::npos; at = xdmf.find(before, at + 1))
  {
    const auto first = at + before.size();
    times.push_back(xdmf.substr(first, xdmf.find('"', first) - first));
  }
  return times;
}
} // namespace

TEST_F(OutputTest, InterfaceIsReadBack)
{
  InterfaceWriter<2> writer(directory, MPI_COMM_SELF, Provenance("gemmule case.prm", {{"End time", "1"}}));
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
  InterfaceWriter<2> writer(directory, MPI_COMM_SELF, Provenance());
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
    InterfaceWriter<2> writer(directory, MPI_COMM_SELF, Provenance("first", {}));
    for (const double time : {0., 0.1, 0.2, 0.3})
      writer.write(circle(time, 0.5));
    Hdf5File file(path("interface.h5"), Hdf5File::Mode::modify);
    file.create_group("step_00004"); // what a kill leaves
  }
  InterfaceWriter<2> resumed(directory, MPI_COMM_SELF, Provenance("second", {}), 0.1);
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
  InterfaceWriter<2> writer(directory, MPI_COMM_SELF, Provenance());
  writer.write(circle(0., 0.5));
  const std::string message = message_of(
      [&]()
      {
        const FullDisk full_disk(std::filesystem::file_size(path("interface.h5")) + 4096);
        writer.write(circle(0.1, 0.5, 5000));
      });
  EXPECT_NE(message.find("interface.h5"), std::string::npos) << message;
  EXPECT_NE(message.find("MB are needed: the file would be larger than files may be here"), std::string::npos)
      << message;

  // The file is unharmed, and the run goes on when there is room again.
  EXPECT_EQ(Hdf5File(path("interface.h5"), Hdf5File::Mode::read).members().size(), 1u);
  writer.write(circle(0.1, 0.5, 5000));
  EXPECT_EQ(Hdf5File(path("interface.h5"), Hdf5File::Mode::read).members().size(), 2u);
}

TEST_F(OutputTest, InterfaceOfADamagedFileFailsReadably)
{
  std::ofstream(path("interface.h5")) << "This is no HDF5 file.";
  const std::string message =
      message_of([&]() { InterfaceWriter<2>(directory, MPI_COMM_SELF, Provenance(), 1.); });
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
    FieldWriter<2> writer(directory, MPI_COMM_WORLD, Provenance("gemmule case.prm", {}));
    for (const double time : {0., 0.5, 1.})
      writer.write(data, time);
  }
  on_rank_zero(MPI_COMM_WORLD,
               [&]()
               {
                 const Hdf5File file(path("solution-00001.h5"), Hdf5File::Mode::read);
                 EXPECT_EQ(file.number_attribute("/", "time"), 0.5);
                 EXPECT_EQ(file.text_attribute("/", "command_line"), "gemmule case.prm");
                 EXPECT_EQ(file.text_attribute("/", "git_revision"), GEMMULE_GIT_REVISION);
                 EXPECT_EQ(file.extent("cells"), (std::vector<std::size_t>{64, 4}));
                 const std::vector<double> nodes = file.read("nodes");
                 const std::vector<double> level_set = file.read("level_set");
                 ASSERT_EQ(nodes.size(), 2 * 4 * 64u);
                 for (unsigned int i = 0; i < level_set.size(); ++i)
                   EXPECT_NEAR(level_set[i], nodes[2 * i], 1e-15);
               });

  const std::string complete = content("solution.xdmf");
  on_rank_zero(MPI_COMM_WORLD,
               [&]() { std::ofstream(path("solution-00002.h5")) << "what is left by an early kill"; });
  FieldWriter<2> resumed(directory, MPI_COMM_WORLD, Provenance(), 2);
  EXPECT_EQ(std::filesystem::exists(path("solution-00001.h5")), true);
  EXPECT_EQ(std::filesystem::exists(path("solution-00002.h5")), false);
  EXPECT_EQ(content("solution.xdmf").find("solution-00002.h5"), std::string::npos);
  resumed.write(data, 1.);
  // The entries of the earlier files were read from them, and must be what was said when they were written.
  EXPECT_EQ(content("solution.xdmf"), complete);
  EXPECT_NE(complete.find("solution-00002.h5:/level_set"), std::string::npos);
}

TEST_F(OutputTest, XdmfHasTheTimesToTheLastDigitAndTheSameInBothFiles)
{
  const std::vector<double> times = {0.,           std::numeric_limits<double>::denorm_min(),
                                     1.2345678e-9, 0.00123456789,
                                     0.0012345699, 0.1 + 0.2,
                                     1. / 3.,      std::nextafter(1. / 3., 1.),
                                     1e9 + 0.125,  std::numeric_limits<double>::max()};
  const CellData cells(MPI_COMM_SELF);
  const auto check = [&]()
  {
    const std::vector<std::string> of_fields = times_of(content("solution.xdmf"));
    ASSERT_EQ(of_fields.size(), times.size());
    EXPECT_EQ(times_of(content("interface.xdmf")), of_fields);
    const Hdf5File interface(path("interface.h5"), Hdf5File::Mode::read);
    for (unsigned int i = 0; i < times.size(); ++i)
    {
      EXPECT_EQ(std::strtod(of_fields[i].c_str(), nullptr), times[i]) << of_fields[i];
      const std::string number = std::to_string(100000 + i).substr(1);
      EXPECT_EQ(interface.number_attribute("step_" + number, "time"), times[i]);
      const Hdf5File fields(path("solution-" + number + ".h5"), Hdf5File::Mode::read);
      EXPECT_EQ(fields.number_attribute("/", "time"), times[i]);
    }
  };
  {
    InterfaceWriter<2> membrane(directory, MPI_COMM_SELF, Provenance());
    FieldWriter<2> fields(directory, MPI_COMM_SELF, Provenance());
    for (const double time : times)
    {
      membrane.write(circle(time, 0.5));
      fields.write(cells.data, time);
    }
  }
  check();
  // Of a resumed run, which reads them from the HDF5 files.
  const InterfaceWriter<2> membrane(directory, MPI_COMM_SELF, Provenance(), times.back());
  const FieldWriter<2> fields(directory, MPI_COMM_SELF, Provenance(), times.size());
  check();
}

// One cell: on two ranks one of them has none, the first or the last.
TEST_F(ParallelOutputTest, FieldsOfRanksWithoutCells)
{
  const int n_ranks = static_cast<int>(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD)),
            rank = static_cast<int>(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
  for (const bool is_reversed : {false, true})
  {
    MPI_Comm communicator = MPI_COMM_NULL;
    MPI_Comm_split(MPI_COMM_WORLD, 0, is_reversed ? n_ranks - rank : rank, &communicator);
    {
      const CellData cell(communicator, 0);
      const unsigned int n_with_cells = dealii::Utilities::MPI::sum(
          cell.triangulation.n_locally_owned_active_cells() > 0 ? 1u : 0u, communicator);
      ASSERT_EQ(n_with_cells, 1u);
      FieldWriter<2> writer(directory, communicator, Provenance());
      writer.write(cell.data, 0.25);
      writer.write(cell.data, 0.5);
      if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        const Hdf5File file(path("solution-00001.h5"), Hdf5File::Mode::read);
        EXPECT_EQ(file.number_attribute("/", "time"), 0.5);
        EXPECT_EQ(file.extent("cells"), (std::vector<std::size_t>{1, 4}));
        EXPECT_EQ(file.extent("nodes"), (std::vector<std::size_t>{4, 2}));
        EXPECT_EQ(file.read("level"), std::vector<double>(4, 1.));
        EXPECT_EQ(times_of(content("solution.xdmf")), (std::vector<std::string>{"0.25", "0.5"}));
        EXPECT_NE(content("solution.xdmf").find("solution-00001.h5:/level"), std::string::npos);
      }
      MPI_Barrier(communicator);
    }
    MPI_Comm_free(&communicator);
  }
}

TEST_F(ParallelOutputTest, FieldsThatAreDamagedOrMissingCostNoOther)
{
  const CellData cells;
  const dealii::DataOut<2> &data = cells.data;
  {
    FieldWriter<2> writer(directory, MPI_COMM_WORLD, Provenance());
    for (const double time : {0., 0.25, 0.5, 0.75, 1.})
      writer.write(data, time);
  }
  on_rank_zero(MPI_COMM_WORLD,
               [&]()
               {
                 std::filesystem::remove(path("solution-00000.h5"));
                 std::ofstream(path("solution-00001.h5")) << "damaged";
               });
  FieldWriter<2> resumed(directory, MPI_COMM_WORLD, Provenance(), 4);
  EXPECT_EQ(resumed.n_files(), 4u);
  resumed.write(data, 1.);
  on_rank_zero(MPI_COMM_WORLD,
               [&]()
               {
                 EXPECT_EQ(resumed.n_listed(), 3u);
                 EXPECT_FALSE(std::filesystem::exists(path("solution-00000.h5")));
                 EXPECT_EQ(content("solution-00001.h5"), "damaged");
                 const std::string xdmf = content("solution.xdmf");
                 for (const unsigned int i : {2, 3, 4})
                 {
                   const std::string name = "solution-0000" + std::to_string(i) + ".h5";
                   const Hdf5File file(path(name), Hdf5File::Mode::read);
                   EXPECT_EQ(file.number_attribute("/", "time"), 0.25 * i);
                   EXPECT_NE(xdmf.find(name), std::string::npos);
                 }
               });
}

TEST_F(ParallelOutputTest, FieldsThatCannotBeWrittenFailOnAllRanks)
{
  const CellData cells;
  const dealii::DataOut<2> &data = cells.data;
  FieldWriter<2> writer(path("missing"), MPI_COMM_WORLD, Provenance());
  const std::string message = message_of([&]() { writer.write(data, 0.); });
  EXPECT_EQ(message, "Cannot write " + path("missing/solution-00000.h5") +
                         ": the file or its directory does not exist. Put it back if it has been moved.");

  FieldWriter<2> on_full_disk(directory, MPI_COMM_WORLD, Provenance());
  const FullDisk full_disk(1000);
  const std::string disk_message = message_of([&]() { on_full_disk.write(data, 0.); });
  EXPECT_NE(disk_message.find("solution-00000.h5, for which"), std::string::npos) << disk_message;
  EXPECT_NE(disk_message.find("the file would be larger than files may be here"), std::string::npos)
      << disk_message;
  on_rank_zero(MPI_COMM_WORLD, [&]() { EXPECT_TRUE(std::filesystem::is_empty(directory)) << "half a file"; });
}
