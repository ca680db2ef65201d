// SPDX-License-Identifier: LGPL-2.1-or-later
// What the stages of the assembly of the flow cost (doc/measurements.md, "Flow"): circle or sphere R = 0.45
// off the grid in [-1,1]^dim, cells of 1/4 (in 2D 1/16) in the bulk and of the given size within 1.5 layers
// of the membrane. CPU seconds of this rank, the least of some rounds: the machine may be busy with other
// things. The membrane moves between the rounds, so that other cells are cut.
#include <gemmule/algebra/linear_system.h>
#include <gemmule/flow/stokes_assembler.h>
#include <gemmule/geometry/cut_geometry.h>
#include <gemmule/parameters/discretisation.h>
#include <gemmule/parameters/fluid.h>

#include <deal.II/base/function_lib.h>
#include <deal.II/base/function_signed_distance.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/numerics/vector_tools.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>

using namespace dealii;
using namespace Gemmule;

namespace
{
constexpr double radius = 0.45, layers = 1.5;

template <typename Action>
double seconds(const Action &action)
{
  Timer timer;
  action();
  return timer.cpu_time();
}

template <int dim>
Point<dim> off_the_grid()
{
  Point<dim> center;
  for (unsigned int d = 0; d < dim; ++d)
    center[d] = 0.013 - 0.006 * d;
  return center;
}

template <int dim>
void refine(parallel::distributed::Triangulation<dim> &triangulation, const unsigned int level)
{
  while (triangulation.n_global_levels() <= level)
  {
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        const double distance = std::abs(cell->center().distance(off_the_grid<dim>()) - radius);
        if (distance < 0.5 * cell->diameter() + layers * std::pow(0.5, level - 1.))
          cell->set_refine_flag();
      }
    triangulation.execute_coarsening_and_refinement();
  }
}

/** The membrane's cells after a shift in the first direction. */
template <int dim>
void cut(const DoFHandler<dim> &dof_handler, const double shift, CutGeometry<dim> &geometry)
{
  IndexSet relevant;
  DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
  LinearAlgebra::distributed::Vector<double> level_set(dof_handler.locally_owned_dofs(), relevant,
                                                       MPI_COMM_WORLD);
  Point<dim> center = off_the_grid<dim>();
  center[0] += shift;
  VectorTools::interpolate(dof_handler, Functions::SignedDistance::Sphere<dim>(center, radius), level_set);
  AffineConstraints<double> hanging_nodes(relevant);
  DoFTools::make_hanging_node_constraints(dof_handler, hanging_nodes);
  hanging_nodes.close();
  hanging_nodes.distribute(level_set);
  level_set.update_ghost_values();
  geometry.reinit(dof_handler, level_set);
}

struct Stages
{
  double geometry, numbering, elements, pattern, kept_pattern, cut_matrices, cut_adding, uncut_adding,
      face_adding, all_values;

  /** Stage by stage the smaller time. */
  void keep_least(const Stages &other)
  {
    for (const auto stage : {&Stages::geometry, &Stages::numbering, &Stages::elements, &Stages::pattern,
                             &Stages::kept_pattern, &Stages::cut_matrices, &Stages::cut_adding,
                             &Stages::uncut_adding, &Stages::face_adding, &Stages::all_values})
      this->*stage = std::min(this->*stage, other.*stage);
  }
};

template <int dim>
class Benchmark
{
public:
  explicit Benchmark(const unsigned int level)
      : triangulation(MPI_COMM_WORLD), level_set_dofs(triangulation), space(triangulation),
        assembler(space, Parameters::Fluid(), Parameters::Flow()), system(MPI_COMM_WORLD, true)
  {
    GridGenerator::hyper_cube(triangulation, -1., 1.);
    triangulation.refine_global(dim == 2 ? 5 : 3);
    refine(triangulation, level);
    level_set_dofs.distribute_dofs(FE_Q<dim>(3));
    space.reinit_mesh();
  }

  Stages run(const double shift)
  {
    Stages s;
    s.geometry = seconds([&] { cut(level_set_dofs, shift, geometry); });
    s.numbering = seconds([&] { number(); });
    s.elements = seconds([&] { add_elements(); });
    s.pattern = seconds([&] { system.finish_elements(); });
    const unsigned int version = system.matrix().pattern_version();
    add_elements();
    s.kept_pattern = seconds([&] { system.finish_elements(); });
    AssertThrow(version == system.matrix().pattern_version(), ExcMessage("The pattern was built twice."));

    auto right_side = system.make_vector();
    s.all_values = seconds([&] { assembler.assemble(geometry, system, right_side); });
    FullMatrix<double> matrix(CutCellMatrix<dim>::n, CutCellMatrix<dim>::n);
    CutCellMatrix<dim> cut_cell_matrix(assembler.fluids(), Parameters::Flow().nitsche_penalty);
    s.cut_matrices = seconds(
        [&]
        {
          for (const auto &cell : geometry.cut_cells())
            cut_cell_matrix.compute(cell, matrix);
        });
    s.cut_adding = seconds(
        [&]
        {
          for (const unsigned int element : assembler.cut_cell_elements())
            system.add_matrix(element, matrix);
        });
    matrix.reinit(StokesLayout<dim>::n, StokesLayout<dim>::n);
    s.uncut_adding = seconds(
        [&]
        {
          for (const auto &cell : assembler.cell_elements())
            if (cell.location != CellLocation::cut)
              system.add_matrix(cell.element, matrix);
        });
    const FullMatrix<double> velocity(2 * StokesLayout<dim>::n_velocity_nodes),
        pressure(2 * StokesLayout<dim>::n_pressure_nodes);
    const unsigned int n_cells = assembler.cell_elements().size();
    s.face_adding = seconds(
        [&]
        {
          for (unsigned int element = n_cells; element < system.n_elements(); ++element)
            system.add_matrix(element, (element - n_cells) % (dim + 1) < dim ? velocity : pressure);
        });
    return s;
  }

  void print(const Stages &s) const
  {
    const unsigned int n_cells = assembler.cell_elements().size(),
                       n_cut = assembler.cut_cell_elements().size();
    unsigned int n_points = 0, n_surface_points = 0;
    for (const auto &cell : geometry.cut_cells())
    {
      n_points += cell.bulk_points[0].size() + cell.bulk_points[1].size();
      n_surface_points += cell.surface_points.size();
    }
    std::cout << n_cells << " cells, " << n_cut << " cut with " << n_points / n_cut << " points and "
              << n_surface_points / n_cut << " on the membrane, " << system.numbering().size()
              << " unknowns, " << system.n_elements() << " elements, " << system.matrix().n_entries()
              << " entries\n";
    const auto line =
        [](const char *const stage, const double time, const unsigned int n, const char *const item)
    {
      std::cout << std::left << std::setw(36) << stage << std::right << std::setw(9) << 1e3 * time << " ms";
      if (n > 0)
        std::cout << std::setw(9) << 1e6 * time / n << " us per " << item;
      std::cout << '\n';
    };
    std::cout << std::fixed << std::setprecision(1);
    line("geometry", s.geometry, n_cut, "cut cell");
    line("numbering", s.numbering, 0, "");
    line("lists of the elements", s.elements, system.n_elements(), "element");
    line("pattern, other cells cut", s.pattern, 0, "");
    line("pattern, kept", s.kept_pattern, 0, "");
    line("all values", s.all_values, 0, "");
    line("  matrices of cut cells", s.cut_matrices, n_cut, "cut cell");
    line("  condensing and adding them", s.cut_adding, n_cut, "cut cell");
    line("  adding uncut cells", s.uncut_adding, n_cells - n_cut, "uncut cell");
    line("  adding faces", s.face_adding, (system.n_elements() - n_cells) / (dim + 1), "face and fluid");
  }

private:
  void number()
  {
    space.reinit(geometry, Functions::ZeroFunction<dim>(dim));
    numbering = BlockNumbering(MPI_COMM_WORLD);
    space.add_fields(numbering);
    numbering.close();
    space.renumber(numbering);
  }

  void add_elements()
  {
    system.begin(numbering);
    assembler.add_elements(geometry, system);
  }

  parallel::distributed::Triangulation<dim> triangulation;
  DoFHandler<dim> level_set_dofs;
  CutGeometry<dim> geometry;
  UnfittedStokesSpace<dim> space;
  BlockNumbering numbering{MPI_COMM_WORLD};
  StokesAssembler<dim> assembler;
  LinearSystem system;
};

template <int dim>
void run(const unsigned int level, const unsigned int n_rounds)
{
  Benchmark<dim> benchmark(level);
  Stages stages = benchmark.run(0.);
  for (unsigned int round = 1; round < n_rounds; ++round)
    stages.keep_least(benchmark.run(round % 2 * std::pow(0.5, level)));
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    benchmark.print(stages);
}
} // namespace

int main(int argc, char **argv)
{
  int n_arguments = 1; // as in w1.cc
  Utilities::MPI::MPI_InitFinalize mpi(n_arguments, argv, 1);
  CLI::App app("What the stages of the assembly of the flow cost.");
  unsigned int dim = 3, cells = 8, n_rounds = 6;
  app.add_option("dimension", dim, "2 or 3")->check(CLI::Range(2, 3))->capture_default_str();
  app.add_option("cells", cells, "1/h at the membrane, a power of two")
      ->check(CLI::Range(4, 1024))
      ->capture_default_str();
  app.add_option("rounds", n_rounds, "of which the least times count")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  const unsigned int level = static_cast<unsigned int>(std::lround(std::log2(2. * cells)));
  if (dim == 2)
    run<2>(level, n_rounds);
  else
    run<3>(level, n_rounds);
}
