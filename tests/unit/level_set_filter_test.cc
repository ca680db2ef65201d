// SPDX-License-Identifier: LGPL-2.1-or-later
// The filter of the level set: what it leaves alone, what it removes, and that it does not diffuse.
#include <gemmule/geometry/level_set_filter.h>

#include <deal.II/base/function_signed_distance.h>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "support/level_set_mesh.h"

namespace Gemmule
{
using namespace dealii;
using Testing::LevelSetMesh;

namespace
{
  template <int dim>
  std::vector<unsigned int> node_to_dof(const LevelSetMesh<dim> &mesh)
  {
    return lexicographic_cell_dofs(static_cast<const FiniteElement<dim> &>(mesh.fe));
  }

  template <int dim>
  void sweep(LevelSetMesh<dim> &mesh, const unsigned int n)
  {
    const auto nodes = node_to_dof(mesh);
    const LevelSetFilter<dim> filter(mesh.dof_handler, nodes);
    const std::vector<bool> all(mesh.dof_handler.get_triangulation().n_active_cells(), true);
    for (unsigned int i = 0; i < n; ++i)
    {
      filter.sweep(mesh.level_set, all);
      mesh.level_set.update_ghost_values();
      mesh.constraints.distribute(mesh.level_set);
      mesh.level_set.update_ghost_values();
    }
  }

  /** Largest |phi - expected| at the nodes of the cells that the zero set cuts, two cells or more from the
   * walls. */
  template <int dim>
  double largest_difference(const LevelSetMesh<dim> &mesh,
                            const std::function<double(const Point<dim> &)> &expected)
  {
    const auto nodes = node_to_dof(mesh);
    std::vector<types::global_dof_index> dofs(nodes.size());
    double largest = 0.;
    for (const auto &cell : mesh.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
      {
        cell->get_dof_indices(dofs);
        bool negative = false, positive = false;
        double difference = 0.;
        for (unsigned int i = 0; i < nodes.size(); ++i)
        {
          const Tensor<1, dim> unit_node(TensorLagrange<dim, 3>::node(i));
          const double phi = mesh.level_set(dofs[nodes[i]]);
          (phi < 0. ? negative : positive) = true;
          difference =
              std::max(difference,
                       std::abs(phi - expected(cell->vertex(0) + cell->extent_in_direction(0) * unit_node)));
        }
        if (negative && positive && std::abs(cell->center()[0]) < 0.8)
          largest = std::max(largest, difference);
      }
    return Utilities::MPI::max(largest, MPI_COMM_WORLD);
  }

  template <int dim>
  void expect_cubic_is_left_alone(const unsigned int level)
  {
    const std::function<double(const Point<dim> &)> cubic = [](const Point<dim> &x) {
      return x.norm_square() - 0.36 + 0.2 * x[0] * x[0] * x[0] - 0.3 * x[0] * x[1] * x[1] + 0.1 * x[dim - 1];
    };
    LevelSetMesh<dim> mesh(level);
    mesh.refine_where([](const Point<dim> &x) { return x[0] + 0.5 * x[1] > 0.; });
    mesh.interpolate(ScalarFunctionFromFunctionObject<dim>(cubic));
    ASSERT_LT(largest_difference(mesh, cubic), 1e-14);
    sweep(mesh, 20);
    EXPECT_LT(largest_difference(mesh, cubic), 1e-13);
  }

  /**
   * What n sweeps leave of a small wave sin(2 pi x / length) of a flat membrane, measured in cells of 1/16.
   */
  double remaining_part(const double length_in_cells, const unsigned int n)
  {
    const double amplitude = 1e-4, k = 2. * numbers::PI / (length_in_cells / 16.);
    const auto flat = [](const Point<2> &x) { return x[1] - 0.02; };
    LevelSetMesh<2> mesh(5);
    mesh.interpolate(ScalarFunctionFromFunctionObject<2>(
        [&](const Point<2> &x) { return flat(x) + amplitude * std::sin(k * x[0]); }));
    const double before = largest_difference<2>(mesh, flat);
    sweep(mesh, n);
    return largest_difference<2>(mesh, flat) / before;
  }
} // namespace

TEST(ParallelLevelSetFilter, LeavesCubicPolynomialsAlone)
{
  expect_cubic_is_left_alone<2>(4);
  expect_cubic_is_left_alone<3>(3);
}

TEST(ParallelLevelSetFilter, DoesNotDiffuseHoweverOftenItIsApplied)
{
  const Functions::SignedDistance::Sphere<2> circle(Point<2>(0.03, 0.01), 0.6);
  for (const bool hanging_nodes : {false, true})
  {
    std::array<double, 2> errors;
    for (unsigned int i = 0; i < 2; ++i)
    {
      LevelSetMesh<2> mesh(4 + i);
      if (hanging_nodes)
        mesh.refine_where([](const Point<2> &x) { return x[0] + 0.5 * x[1] > 0.; });
      mesh.interpolate(circle);
      sweep(mesh, 500);
      errors[i] = largest_difference<2>(mesh, [&](const Point<2> &x) { return circle.value(x); });
    }
    const double order = std::log2(errors[0] / errors[1]);
    std::cout << (hanging_nodes ? "two levels" : "one level") << ", h = 1/8, 1/16: " << errors[0] << " "
              << errors[1] << ", order " << order << std::endl;
    EXPECT_GT(order, 3.5);
  }
}

TEST(ParallelLevelSetFilter, RemovesWhatNoForceSeesAndLeavesTheRest)
{
  // Waves of a cell or half of one that vanish at the faces are cubic bubbles and nothing else.
  EXPECT_LT(remaining_part(0.5, 50), 1e-6);
  EXPECT_LT(remaining_part(1., 50), 1e-6);
  for (const double length : {2., 4., 8.})
  {
    const double remaining = remaining_part(length, 1000);
    std::cout << "wave of " << length << " cells: " << remaining << " is left" << std::endl;
    EXPECT_NEAR(remaining, 1., 0.01);
  }
}

TEST(ParallelLevelSetFilter, LeavesCornersAlone)
{
  // A square: slopes jump by one or more at the corners and at the medial axis that ends there.
  const auto square = [](const Point<2> &x) { return std::max(std::abs(x[0]), std::abs(x[1])) - 0.5; };
  LevelSetMesh<2> mesh(4);
  mesh.interpolate(ScalarFunctionFromFunctionObject<2>(square));
  sweep(mesh, 100);
  EXPECT_LT(largest_difference<2>(mesh, square), 0.01);
}
} // namespace Gemmule
