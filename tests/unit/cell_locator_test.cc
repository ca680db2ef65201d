// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/mesh/cell_locator.h>

#include <deal.II/base/mpi.h>
#include <deal.II/distributed/tria.h>
#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>
#include <random>

using namespace Gemmule;
using namespace dealii;

namespace
{
/** Three levels around the circle of radius 0.5, on a box of 2 x 1 (x 1) coarse cells whose corners are no
 * binary fractions. */
template <int dim>
void make_mesh(parallel::distributed::Triangulation<dim> &mesh)
{
  std::vector<unsigned int> n(dim, 1);
  n[0] = 2;
  Point<dim> lower, upper;
  for (unsigned int d = 0; d < dim; ++d)
  {
    lower[d] = -0.3;
    upper[d] = d == 0 ? 1.1 : 0.4;
  }
  GridGenerator::subdivided_hyper_rectangle(mesh, n, lower, upper);
  mesh.refine_global(2);
  for (unsigned int i = 0; i < 2; ++i)
  {
    for (const auto &cell : mesh.active_cell_iterators())
      if (cell->is_locally_owned() && std::abs(cell->center().norm() - 0.5) < 0.1)
        cell->set_refine_flag();
    mesh.execute_coarsening_and_refinement();
  }
}

template <int dim>
void expect_points_are_found()
{
  parallel::distributed::Triangulation<dim> mesh(MPI_COMM_WORLD);
  make_mesh(mesh);
  CellLocator<dim> locator;
  locator.reinit(mesh);

  std::vector<typename Triangulation<dim>::active_cell_iterator> by_index(mesh.n_active_cells());
  for (const auto &cell : mesh.active_cell_iterators())
    by_index[cell->active_cell_index()] = cell;

  std::vector<Point<dim>> points;
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(0., 1.);
  for (unsigned int i = 0; i < 2000; ++i)
  {
    Point<dim> x;
    for (unsigned int d = 0; d < dim; ++d)
      x[d] = -0.3 + (d == 0 ? 1.4 : 0.7) * uniform(generator);
    if (i % 4 == 0) // put the point on a face
      x[i % dim] = -0.3 + 0.7 / 16. * (i % 16);
    points.push_back(x);
  }
  points.push_back(Point<dim>() + (dim == 2 ? Point<dim>(1.1, 0.4) - Point<dim>() : Tensor<1, dim>()));

  std::vector<int> found(points.size(), 0);
  for (unsigned int i = 0; i < points.size(); ++i)
    if (const auto *cell = locator.find(points[i]))
    {
      found[i] = 1;
      EXPECT_TRUE(by_index[cell->active_cell_index]->is_locally_owned());
      EXPECT_LT((by_index[cell->active_cell_index]->vertex(0) - cell->corner).norm(), 1e-14);
      EXPECT_NEAR((cell->corner + cell->size * Tensor<1, dim>(cell->unit(points[i]))).distance(points[i]), 0.,
                  1e-14);
    }
  Utilities::MPI::sum(found, MPI_COMM_WORLD, found);
  for (unsigned int i = 0; i < points.size(); ++i)
    EXPECT_EQ(found[i], 1) << "point " << points[i];
}
} // namespace

TEST(ParallelCellLocator, EveryPointIsFoundOnExactlyOneRank)
{
  expect_points_are_found<2>();
  expect_points_are_found<3>();
}

TEST(CellLocator, PointOnAFaceBelongsToTheLargerCoordinates)
{
  Triangulation<2> mesh;
  GridGenerator::hyper_cube(mesh, 0., 1.);
  mesh.refine_global(1);
  CellLocator<2> locator;
  locator.reinit(mesh);
  EXPECT_EQ(locator.find({0.5, 0.5})->corner, Point<2>(0.5, 0.5));
  EXPECT_EQ(locator.find({0.5, 0.25})->corner, Point<2>(0.5, 0.));
  EXPECT_EQ(locator.find({1., 1.})->corner, Point<2>(0.5, 0.5));
  EXPECT_EQ(locator.find({1.01, 0.5}), nullptr);
  EXPECT_EQ(locator.find({-0.01, 0.5}), nullptr);
  EXPECT_DOUBLE_EQ(locator.smallest_size(), 0.5);
}
