// SPDX-License-Identifier: LGPL-2.1-or-later
// Iterations, times and memory of the solvers of the flow (doc/performance.md) on a circle or sphere of
// radius 0.45 in [-1, 1]^dim, with cells of one size around it and coarser ones elsewhere.
#include <gemmule/flow/flow_system_solver.h>
#include <gemmule/flow/semi_implicit_bending.h>
#include <gemmule/flow/semi_implicit_tension.h>
#include <gemmule/flow/stokes_solver.h>
#include <gemmule/flow/tension_force.h>
#include <gemmule/geometry/interface.h>
#include <gemmule/parameters/discretisation.h>
#include <gemmule/parameters/fluid.h>

#include <deal.II/base/function_lib.h>
#include <deal.II/base/function_signed_distance.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>
#include <deal.II/base/utilities.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>

#include <CLI/CLI.hpp>
#include <iostream>

#include "../support/circle_flow.h"
#include "../support/sphere_flow.h"

using namespace dealii;
using namespace Gemmule;

namespace
{
struct Settings
{
  unsigned int dimension = 3;
  unsigned int bulk_level = 3, membrane_level = 4;
  double layers = 1.5;
  bool is_chequered = false;
  double shift = 0.;
  double viscosity_ratio = 1.;
  double bending = 0., tension = 0.;
  double tolerance = 1e-8;
  std::string solver = "iterative";
  unsigned int mode = 0;
};

/** The solver of the program, of which the times are taken. */
class TimedSolver : public FlowLinearSolver
{
public:
  TimedSolver(const unsigned int dimension, const Parameters::Flow &parameters)
      : solver(MPI_COMM_WORLD, dimension, parameters)
  {
  }
  void prepare(const SubassembledMatrix &matrix, const BlockNumbering &numbering, const Index fixed) override
  {
    solver.set_structure_source(find_structure);
    Timer timer(MPI_COMM_WORLD);
    solver.prepare(matrix, numbering, fixed);
    setup = timer.cpu_time();
    n_entries = Utilities::MPI::sum(static_cast<double>(matrix.n_entries()), MPI_COMM_WORLD);
    n_unknowns = numbering.size();
  }
  void solve(const std::vector<Vector> &right_sides, std::vector<Vector> &solutions) override
  {
    Timer timer(MPI_COMM_WORLD);
    solver.solve(right_sides, solutions);
    solution = timer.cpu_time();
  }
  Report report() const override { return solver.report(); }

  double setup = 0., solution = 0., n_entries = 0.;
  types::global_dof_index n_unknowns = 0;

private:
  FlowSystemSolver solver;
};

template <int dim>
void run(const Settings &settings)
{
  parallel::distributed::Triangulation<dim> triangulation(MPI_COMM_WORLD);
  GridGenerator::hyper_cube(triangulation, -1., 1.);
  triangulation.refine_global(settings.bulk_level);
  const double h = 2. / (1u << settings.membrane_level), radius = 0.45;
  Point<dim> center;
  for (unsigned int d = 0; d < dim; ++d)
    center[d] = (d == 1 ? 0.007 : 0.013 - 0.012 * d) + settings.shift * h * (1. - 0.3 * d);
  const auto refine = [&](const double width, const bool alternate)
  {
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        const Point<dim> p = cell->center();
        int parity = 0;
        for (unsigned int d = 0; d < dim; ++d)
          parity += static_cast<int>(std::floor((p[d] + 1.) / cell->extent_in_direction(0)));
        if (std::abs(p.distance(center) - radius) < width && (!alternate || parity % 2 == 0))
          cell->set_refine_flag();
      }
    triangulation.execute_coarsening_and_refinement();
  };
  for (unsigned int level = settings.bulk_level; level < settings.membrane_level; ++level)
  {
    const double cell = 2. / (1u << level);
    refine(0.5 * std::sqrt(1. * dim) * cell + settings.layers * h, false);
  }
  if (settings.is_chequered)
    refine(h, true);

  Interface<dim> interface(triangulation);
  interface.reinit_mesh();
  interface.interpolate(Functions::SignedDistance::Sphere<dim>(center, radius));
  interface.cut();
  const auto &geometry = interface.geometry();

  Parameters::Flow parameters;
  parameters.solver_tolerance = settings.tolerance;
  parameters.solver =
      settings.solver == "direct" ? Parameters::FlowSolver::direct : Parameters::FlowSolver::iterative;
  auto owned_solver = std::make_unique<TimedSolver>(dim, parameters);
  TimedSolver &solver = *owned_solver;
  const Parameters::Fluid fluid{1., settings.viscosity_ratio};
  StokesSolver<dim> flow(triangulation, fluid, parameters, std::move(owned_solver));
  flow.reinit_mesh();

  using Exact = std::conditional_t<dim == 2, Testing::CircleFlow, Testing::SphereFlow>;
  const Exact exact(center, radius, std::max(settings.mode, 1u), 0.5, settings.viscosity_ratio);
  MembranePointValues tension;
  for (const auto &cell : geometry.cut_cells())
  {
    tension.emplace_back();
    for (const auto &p : cell.surface_points)
      tension.back().push_back(exact.tension(cell.physical(p)));
  }
  typename StokesSolver<dim>::Terms terms{std::make_shared<TensionForce<dim>>(tension, 1.)};
  using Nodal = std::array<Tensor<1, dim>, TensorLagrange<dim, 3>::n>;
  const std::vector<Nodal> at_rest(geometry.cut_cells().size());
  if (settings.tension > 0.)
    terms.push_back(std::make_shared<SemiImplicitTension<dim>>(
        typename SemiImplicitTension<dim>::Parameters{settings.tension, tension, {}, at_rest}, 1.));
  if (settings.bending > 0.)
  {
    auto space = std::make_shared<TraceSpace<dim>>(triangulation);
    space->reinit_mesh();
    space->prepare(interface, {{nullptr, nullptr}});
    terms.push_back(std::make_shared<SemiImplicitBending<dim>>(settings.bending, space, at_rest, 1.));
  }

  Timer assembly(MPI_COMM_WORLD);
  const Functions::ZeroFunction<dim> at_rest_there(dim);
  flow.prepare(geometry, settings.mode > 0 ? static_cast<const Function<dim> &>(exact) : at_rest_there,
               terms);
  const double assembly_time = assembly.cpu_time() - solver.setup;
  flow.solve();

  double error = 0.;
  for (unsigned int k = 0; k < geometry.cut_cells().size(); ++k)
  {
    const auto &cell = geometry.cut_cells()[k];
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
      error += cell.surface_weights[q] * (flow.membrane_velocity()[k].value(cell.surface_points[q]) -
                                          exact.velocity(cell.physical(cell.surface_points[q])))
                                             .norm_square();
  }
  error = std::sqrt(Utilities::MPI::sum(error, MPI_COMM_WORLD));

  const auto cut =
      Utilities::MPI::sum(static_cast<unsigned int>(geometry.cut_cells().size()), MPI_COMM_WORLD);
  const auto report = flow.linear_solver_report();
  const double largest_speed = flow.max_velocity(),
               solver_memory = Utilities::MPI::sum(report.memory, MPI_COMM_WORLD);
  Utilities::System::MemoryStats memory;
  Utilities::System::get_memory_stats(memory);
  const double peak = Utilities::MPI::sum(static_cast<double>(memory.VmHWM), MPI_COMM_WORLD);
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    std::cout << triangulation.n_global_active_cells() << " cells, " << cut << " cut, " << solver.n_unknowns
              << " unknowns: " << report.method << ", " << report.iterations
              << " iterations; CPU s: assembly " << assembly_time << ", setup " << solver.setup << ", solve "
              << solver.solution << " (" << 1e6 * solver.solution / solver.n_unknowns << " us per unknown); "
              << solver.n_entries / 1e6 << " M entries, solver " << solver_memory / 1e6
              << " MB, peak of the process " << peak / 1e3 << " MB; largest speed " << largest_speed
              << (settings.mode > 0 ? "; error of <u> " + std::to_string(1e6 * error) + "e-6" : "")
              << std::endl;
}
} // namespace

int main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Settings settings;
  CLI::App app("Solves one flow, and says what that takes.");
  app.add_option("--dimension", settings.dimension);
  app.add_option("--bulk-level", settings.bulk_level, "cells have the size 2/2^level");
  app.add_option("--membrane-level", settings.membrane_level);
  app.add_option("--layers", settings.layers, "of fine cells beside the membrane");
  app.add_flag("--chequered", settings.is_chequered, "refine every other cell at the membrane once more");
  app.add_option("--shift", settings.shift, "of the centre, in cells");
  app.add_option("--viscosity-ratio", settings.viscosity_ratio);
  app.add_option("--bending", settings.bending, "coefficient S dt k of the semi-implicit bending");
  app.add_option("--tension", settings.tension, "coefficient S dt of the semi-implicit tension");
  app.add_option("--tolerance", settings.tolerance);
  app.add_option("--solver", settings.solver, "direct or iterative");
  app.add_option("--mode", settings.mode,
                 "1 or 2: the exact flow on the walls, and the error on the membrane");
  CLI11_PARSE(app, argc, argv);
  try
  {
    settings.dimension == 2 ? run<2>(settings) : run<3>(settings);
  }
  catch (const std::exception &error)
  {
    std::cerr << error.what() << std::endl;
    return 1;
  }
}
