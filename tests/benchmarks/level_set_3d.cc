// SPDX-License-Identifier: LGPL-2.1-or-later
// What a step of the level set costs in 3D (doc/performance.md): a sphere that moves by a fifth of a cell, on
// meshes of 1/4 with the cells around the sphere refined to 1/8, 1/16 and so on; CPU seconds of the slowest
// rank, and how they grow beside the number of cut cells.
//   benchmark_level_set_3d [FINEST LEVEL]      5: h = 1/16, the default
#include <gemmule/geometry/interface.h>
#include <gemmule/geometry/membrane_transport.h>

#include <deal.II/base/function_signed_distance.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/timer.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>

#include <iomanip>
#include <iostream>
#include <memory>
#include <string>

using namespace dealii;
using namespace Gemmule;

namespace
{
constexpr unsigned int bulk_level = 3;
constexpr double radius = 0.45;
const Point<3> center(0.013, 0.007, -0.021), origin(-1., -1., -1.);

struct Costs
{
  unsigned int cells = 0, cut_cells = 0, narrow_band = 0;
  double projection = 0.; ///< samples of the membrane, search trees
  double step = 0.;       ///< on the same mesh
  double step_on_new_mesh = 0.;
  double transport = 0.; ///< fields of the membrane
};

/** CPU seconds of the slowest rank. */
template <typename Action>
double seconds(const Action &action)
{
  Timer timer;
  action();
  return Utilities::MPI::max(timer.cpu_time(), MPI_COMM_WORLD);
}

void refine(parallel::distributed::Triangulation<3> &triangulation, const unsigned int level)
{
  GridGenerator::hyper_cube(triangulation, -1., 1.);
  triangulation.refine_global(bulk_level);
  const double layers = (1.5 + 0.5 * std::sqrt(3.)) * std::ldexp(2., -static_cast<int>(level));
  for (unsigned int l = bulk_level; l < level; ++l)
  {
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned() && std::abs(cell->center().distance(center) - radius) <
                                          layers + 0.5 * std::sqrt(3.) * cell->extent_in_direction(0))
        cell->set_refine_flag();
    triangulation.execute_coarsening_and_refinement();
  }
}

/** Velocity (1, 0.5, 0.3) for all nodes of the membrane. */
std::vector<MembraneFields<3>> fields(const CutGeometry<3> &geometry)
{
  std::vector<MembraneFields<3>> result(geometry.cut_cells().size());
  for (auto &field : result)
    field.velocity.fill(Tensor<1, 3>({1., 0.5, 0.3}));
  return result;
}

Costs measure(const unsigned int level)
{
  parallel::distributed::Triangulation<3> triangulation(MPI_COMM_WORLD);
  refine(triangulation, level);
  Interface<3> interface(triangulation);
  interface.reinit_mesh();
  interface.interpolate(Functions::SignedDistance::Sphere<3>(center, radius));
  interface.cut();
  // The band of the first level comes from the sphere itself, that of the others from the steps.
  interface.set_distance(
      MembraneProjection<3>(gather_bare_patches(interface.geometry(), MPI_COMM_WORLD), origin));
  interface.cut();

  Costs costs;
  const double h = std::ldexp(2., -static_cast<int>(level));
  for (const bool is_new : {false, true})
  {
    const auto patches =
        gather_patches(interface.geometry().cut_cells(), fields(interface.geometry()), MPI_COMM_WORLD);
    const auto cloud = gather_cloud(bare_cloud(interface.geometry()), MPI_COMM_WORLD);
    const auto band = interface.level_set().gather_narrow_band();
    costs.narrow_band = band.size();
    std::unique_ptr<MembraneProjection<3>> membrane;
    costs.projection = seconds([&] { membrane = std::make_unique<MembraneProjection<3>>(patches, origin); });
    const MembraneMotion<3> motion(*membrane, TimeStep(0.2 * h));
    if (is_new)
      interface.forget_far_nodes();
    (is_new ? costs.step_on_new_mesh : costs.step) =
        seconds([&] { interface.move(motion, NarrowBandLevelSet<3>(band, origin, &cloud), false); });
    interface.cut();
    costs.transport = seconds([&] { transport_fields(motion, interface.geometry().cut_cells()); });
  }
  costs.cells = triangulation.n_global_active_cells();
  costs.cut_cells = Utilities::MPI::sum(interface.geometry().cut_cells().size(), MPI_COMM_WORLD);
  return costs;
}
} // namespace

int main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  const unsigned int finest_level = argc > 1 ? std::stoi(argv[1]) : 5;
  ConditionalOStream out(std::cout, Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0);
  out << "    h   cells  cut  band   samples, trees   step   step on a new mesh   fields   step per cut "
         "cell\n"
      << std::fixed;
  Costs coarser;
  for (unsigned int level = bulk_level + 1; level <= finest_level; ++level)
  {
    const Costs costs = measure(level);
    out << " 1/" << std::setw(2) << (1 << (level - 1)) << std::setw(8) << costs.cells << std::setw(5)
        << costs.cut_cells << std::setw(6) << costs.narrow_band << std::setprecision(3) << std::setw(15)
        << costs.projection << " s" << std::setw(8) << costs.step << " s" << std::setw(17)
        << costs.step_on_new_mesh << " s" << std::setw(9) << costs.transport << " s" << std::setprecision(2)
        << std::setw(12) << 1e3 * costs.step / costs.cut_cells << " ms";
    if (coarser.cut_cells > 0)
      out << "   (cut cells times " << static_cast<double>(costs.cut_cells) / coarser.cut_cells
          << ", step times " << costs.step / coarser.step << ", on a new mesh times "
          << costs.step_on_new_mesh / coarser.step_on_new_mesh << ")";
    out << std::endl;
    coarser = costs;
  }
}
