// SPDX-License-Identifier: LGPL-2.1-or-later
// What it would cost to assemble the flow into a matrix of Trilinos before the direct solver gets it
// (doc/measurements.md, "Flow"): the same elements with the same values, summed by SubassembledMatrix and by
// TrilinosWrappers::SparseMatrix; CPU seconds of one round on one rank.
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
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>
#include <deal.II/numerics/vector_tools.h>

#include <Epetra_CrsMatrix.h>
#include <iostream>

using namespace dealii;
using namespace Gemmule;

namespace
{
/** Seconds of the second of two calls: the first one touches the memory. */
template <typename Action>
double seconds(const Action &action)
{
  action();
  Timer timer;
  action();
  return timer.cpu_time();
}

struct Element
{
  std::vector<types::global_dof_index> unknowns;
  FullMatrix<double> matrix;
};
} // namespace

int main(int argc, char **argv)
{
  Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  parallel::distributed::Triangulation<2> triangulation(MPI_COMM_WORLD);
  GridGenerator::hyper_cube(triangulation, -1., 1.);
  triangulation.refine_global(4);
  // Cells of 1/32 around the membrane, as in parameters/examples/quick.prm.
  const Point<2> center(0.013, 0.007);
  for (const auto &cell : triangulation.active_cell_iterators())
    if (std::abs(cell->center().distance(center) - 0.45) < 0.25)
      cell->set_refine_flag();
  triangulation.execute_coarsening_and_refinement();

  DoFHandler<2> dof_handler(triangulation);
  const FE_Q<2> cubic(3);
  dof_handler.distribute_dofs(cubic);
  LinearAlgebra::distributed::Vector<double> level_set(dof_handler.locally_owned_dofs(),
                                                       dof_handler.locally_owned_dofs(), MPI_COMM_WORLD);
  VectorTools::interpolate(dof_handler, Functions::SignedDistance::Sphere<2>(center, 0.45), level_set);
  AffineConstraints<double> hanging_nodes;
  DoFTools::make_hanging_node_constraints(dof_handler, hanging_nodes);
  hanging_nodes.close();
  hanging_nodes.distribute(level_set);
  CutGeometry<2> geometry;
  geometry.reinit(dof_handler, level_set);

  UnfittedStokesSpace<2> space(triangulation);
  space.reinit_mesh();
  space.reinit(geometry, Functions::ZeroFunction<2>(2));
  BlockNumbering numbering(MPI_COMM_WORLD);
  space.add_fields(numbering);
  numbering.close();
  space.renumber(numbering);
  StokesAssembler<2> assembler(space, Parameters::Fluid(), Parameters::Flow());
  LinearSystem system(MPI_COMM_WORLD, true);
  const auto set_up = [&]
  {
    system.begin(numbering);
    assembler.add_elements(geometry, system);
    system.finish_elements();
  };
  set_up();
  auto right_side = system.make_vector();
  const double present = seconds([&] { assembler.assemble(geometry, system, right_side); });
  const double factorisation = seconds([&] { system.factorise(); });

  // The elements' condensed matrices stand for those that would be added: as many entries at the same places.
  std::vector<Element> elements;
  for (unsigned int e = 0; e < system.n_elements(); ++e)
  {
    Element element;
    element.unknowns = system.element_unknowns(e);
    element.matrix.reinit(element.unknowns.size(), element.unknowns.size());
    elements.push_back(std::move(element));
  }
  TrilinosWrappers::SparseMatrix matrix;
  const double pattern_seconds = seconds(
      [&]
      {
        TrilinosWrappers::SparsityPattern pattern(numbering.locally_owned(), MPI_COMM_WORLD);
        for (const auto &element : elements)
          for (const auto row : element.unknowns)
            pattern.add_entries(row, element.unknowns.begin(), element.unknowns.end(), true);
        pattern.compress();
        matrix.reinit(pattern);
      });
  const double values_seconds = seconds(
      [&]
      {
        matrix = 0.;
        for (const auto &element : elements)
          matrix.add(element.unknowns, element.unknowns, element.matrix, false);
        matrix.compress(VectorOperation::add);
      });
  std::vector<double> upper;
  const double extraction_seconds = seconds(
      [&]
      {
        upper.clear();
        for (int row = 0; row < matrix.trilinos_matrix().NumMyRows(); ++row)
        {
          int n_entries = 0, *columns = nullptr;
          double *values = nullptr;
          matrix.trilinos_matrix().ExtractMyRowView(row, n_entries, values, columns);
          for (int k = 0; k < n_entries; ++k)
            if (columns[k] >= row)
              upper.push_back(values[k]);
        }
      });
  std::cout << numbering.size() << " unknowns, " << system.n_elements() << " elements, " << upper.size()
            << " entries of one triangle\n"
            << "factorisation by MUMPS                      " << factorisation << " s\n"
            << "element matrices and SubassembledMatrix     " << present << " s\n"
            << "in addition, for a matrix of Trilinos:\n"
            << "  pattern                                   " << pattern_seconds << " s\n"
            << "  adding the elements                       " << values_seconds << " s\n"
            << "  one triangle for MUMPS                    " << extraction_seconds << " s\n";
}
