// SPDX-License-Identifier: LGPL-2.1-or-later
// Which cells the adaptation makes for given samples of a membrane.
#include <gemmule/base/gather.h>
#include <gemmule/mesh/mesh_adaptation.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>
#include <deal.II/grid/grid_generator.h>

#include <cmath>
#include <gtest/gtest.h>

using namespace Gemmule;
using namespace dealii;

namespace
{
constexpr double mixed = 0.5, pure = 0.99;

/** The box [-1, 1]^dim, whose cells of level l have the size 2^(1-l), with its adaptation. */
template <int dim>
struct AdaptiveBox
{
  explicit AdaptiveBox(const Parameters::Mesh &parameters)
      : parameters(parameters), triangulation(MPI_COMM_WORLD, Triangulation<dim>::MeshSmoothing::none),
        adaptation(fill(), parameters)
  {
  }

  parallel::distributed::Triangulation<dim> &fill()
  {
    GridGenerator::hyper_cube(triangulation, -1., 1.);
    triangulation.refine_global(parameters.bulk_level);
    return triangulation;
  }

  unsigned long n_cells() const { return triangulation.n_global_active_cells(); }

  /** Calls @p action for the owned cells. */
  template <typename Action>
  void for_owned_cells(const Action &action) const
  {
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        action(cell);
  }

  int finest_level() const
  {
    int level = 0;
    for_owned_cells([&](const auto &cell) { level = std::max(level, cell->level()); });
    return Utilities::MPI::max(level, MPI_COMM_WORLD);
  }

  const Parameters::Mesh parameters;
  parallel::distributed::Triangulation<dim> triangulation;
  MeshAdaptation<dim> adaptation;
};

Parameters::Mesh levels(const unsigned int bulk, const unsigned int membrane,
                        const unsigned int phase_boundary)
{
  Parameters::Mesh parameters;
  parameters.bulk_level = bulk;
  parameters.membrane_level = membrane;
  parameters.phase_boundary_level = phase_boundary;
  // only what a test is about
  parameters.cells_per_gap = parameters.curvature_tolerance = 0.;
  return parameters;
}

/** Samples on a circle (a great circle in 3D), with mixed composition where x > 0.2. */
template <int dim>
std::vector<MembraneSample<dim>> circle(const Point<dim> &center, const double radius,
                                        const unsigned int n = 400)
{
  std::vector<MembraneSample<dim>> samples(n);
  for (unsigned int i = 0; i < n; ++i)
  {
    // irrational offset: no sample on a face of a cell
    const double angle = 2. * numbers::PI * (i + 0.137) / n;
    samples[i].point = center;
    samples[i].point[0] += radius * std::cos(angle);
    samples[i].point[1] += radius * std::sin(angle);
    samples[i].composition = samples[i].point[0] > 0.2 ? mixed : pure;
  }
  return samples;
}

/** Number of cells that overlap the layers around a sample and are coarser than the sample asks for. */
template <int dim>
unsigned int n_too_coarse(const AdaptiveBox<dim> &box, const std::vector<MembraneSample<dim>> &samples,
                          const unsigned int layers)
{
  unsigned int n = 0;
  box.for_owned_cells(
      [&](const auto &cell)
      {
        bool too_coarse = false;
        for (const auto &sample : samples)
        {
          const int level = *sample.composition == mixed ? box.parameters.phase_boundary_level
                                                         : box.parameters.membrane_level;
          const double h = std::ldexp(2., -level);
          bool overlaps = true;
          for (unsigned int d = 0; d < dim; ++d)
          {
            const double first = std::floor((sample.point[d] + 1.) / h) - layers,
                         end = first + 2. * layers + 1.;
            const double lower = (cell->vertex(0)[d] + 1.) / h, size = cell->extent_in_direction(d) / h;
            overlaps = overlaps && lower + size > first + 1e-6 && lower < end - 1e-6;
          }
          too_coarse = too_coarse || (overlaps && cell->level() < level);
        }
        n += too_coarse;
      });
  return Utilities::MPI::sum(n, MPI_COMM_WORLD);
}

template <int dim>
void expect_layers(const unsigned int bulk, const unsigned int membrane, const unsigned int phase_boundary)
{
  for (const unsigned int layers : {1u, 2u, 3u})
  {
    Parameters::Mesh parameters = levels(bulk, membrane, phase_boundary);
    parameters.membrane_layers = layers;
    AdaptiveBox<dim> box(parameters);
    const auto samples = circle<dim>(Point<dim>(), 0.45);
    EXPECT_GT(n_too_coarse(box, samples, layers), 0u);
    EXPECT_TRUE(box.adaptation.is_too_coarse(samples, layers));
    EXPECT_TRUE(box.adaptation.adapt(samples));
    EXPECT_EQ(n_too_coarse(box, samples, layers), 0u);
    EXPECT_FALSE(box.adaptation.is_too_coarse(samples, layers));
    EXPECT_EQ(box.finest_level(), static_cast<int>(phase_boundary));
    EXPECT_EQ(box.adaptation.lowered_levels(), 0u);
    // The finest cells stay near the samples that ask for them.
    const double reach = (layers + 3.) * std::ldexp(2., -static_cast<int>(phase_boundary));
    box.for_owned_cells(
        [&](const auto &cell)
        {
          if (cell->level() == static_cast<int>(phase_boundary))
          {
            EXPECT_GT(cell->center()[0], 0.2 - reach);
          }
        });
  }
}
} // namespace

TEST(ParallelMeshAdaptation, LayersOfTheAskedLevelsAroundTheMembrane)
{
  expect_layers<2>(2, 5, 6);
}

TEST(ParallelMeshAdaptation, LayersInThreeDimensions)
{
  expect_layers<3>(2, 3, 4);
}

TEST(ParallelMeshAdaptation, NeighboursDifferByOneLevelAtMost)
{
  AdaptiveBox<2> box(levels(1, 6, 7));
  box.adaptation.adapt(circle<2>(Point<2>(0.1, -0.07), 0.4));
  // Also across vertices. The cells around a vertex are complete where one of them is owned.
  std::vector<std::array<int, 2>> range(box.triangulation.n_vertices(), {{100, -1}});
  std::vector<bool> is_inner(box.triangulation.n_vertices(), false);
  for (const auto &cell : box.triangulation.active_cell_iterators())
    if (!cell->is_artificial())
      for (const unsigned int v : cell->vertex_indices())
      {
        auto &r = range[cell->vertex_index(v)];
        r = {{std::min(r[0], cell->level()), std::max(r[1], cell->level())}};
        is_inner[cell->vertex_index(v)] = is_inner[cell->vertex_index(v)] || cell->is_locally_owned();
      }
  unsigned int n_steps = 0;
  for (unsigned int v = 0; v < range.size(); ++v)
    if (is_inner[v])
    {
      EXPECT_LE(range[v][1] - range[v][0], 1) << box.triangulation.get_vertices()[v];
      n_steps += range[v][1] != range[v][0];
    }
  EXPECT_GT(Utilities::MPI::sum(n_steps, MPI_COMM_WORLD), 10u);
}

TEST(ParallelMeshAdaptation, CoarsensWhereTheMembraneHasLeft)
{
  const auto parameters = levels(2, 5, 6);
  const auto there = circle<2>(Point<2>(-0.6, -0.6), 0.2);
  AdaptiveBox<2> box(parameters), fresh(parameters);
  box.adaptation.adapt(circle<2>(Point<2>(0.5, 0.5), 0.3));
  const auto cells_before = box.n_cells();
  EXPECT_TRUE(box.adaptation.adapt(there));
  fresh.adaptation.adapt(there);
  EXPECT_EQ(n_too_coarse(box, there, parameters.membrane_layers), 0u);
  EXPECT_LT(box.n_cells(), cells_before);
  // One layer more may stay than a fresh mesh has.
  EXPECT_GE(box.n_cells(), fresh.n_cells());
  EXPECT_LT(box.n_cells(), 1.3 * fresh.n_cells());
  box.for_owned_cells(
      [&](const auto &cell)
      {
        if (cell->vertex(0)[0] >= 0.5 && cell->vertex(0)[1] >= 0.5)
        {
          EXPECT_EQ(cell->level(), 2) << "cells at the old place stay refined at " << cell->center();
        }
      });
}

TEST(ParallelMeshAdaptation, SmallMotionsDoNotMakeTheMeshFlicker)
{
  const auto parameters = levels(2, 5, 6);
  const double h = std::ldexp(2., -6);
  AdaptiveBox<2> box(parameters);
  const auto here = circle<2>(Point<2>(), 0.45);
  EXPECT_TRUE(box.adaptation.adapt(here));
  EXPECT_FALSE(box.adaptation.adapt(here)) << "the same samples again";

  // To and fro by less than a cell: what both positions need is kept by both.
  auto there = here;
  for (auto &sample : there)
    sample.point += Tensor<1, 2>({0.7 * h, 0.3 * h});
  box.adaptation.adapt(there);
  const auto n_cells = box.n_cells();
  for (unsigned int i = 0; i < 3; ++i)
  {
    EXPECT_FALSE(box.adaptation.adapt(here));
    EXPECT_FALSE(box.adaptation.adapt(there));
  }
  EXPECT_EQ(box.n_cells(), n_cells);
}

TEST(ParallelMeshAdaptation, NoticesThatTheMembraneHasUsedUpItsLayers)
{
  auto parameters = levels(2, 5, 5);
  parameters.membrane_layers = 2;
  AdaptiveBox<2> box(parameters);
  const double h = std::ldexp(2., -5);
  auto samples = circle<2>(Point<2>(), 0.45);
  box.adaptation.adapt(samples);
  const auto moved_by = [&](const double distance)
  {
    auto moved = samples;
    for (auto &sample : moved)
      sample.point[0] += distance;
    return moved;
  };
  EXPECT_FALSE(box.adaptation.is_too_coarse(moved_by(0.99 * h), 1));
  EXPECT_TRUE(box.adaptation.is_too_coarse(moved_by(3. * h), 1));
  EXPECT_FALSE(box.adaptation.is_too_coarse(moved_by(0.), 2));
}

TEST(ParallelMeshAdaptation, LimitOnTheNumberOfCellsLowersTheFinestLevel)
{
  auto parameters = levels(2, 6, 8);
  AdaptiveBox<2> unlimited(parameters);
  const auto samples = circle<2>(Point<2>(), 0.45, 2000);
  unlimited.adaptation.adapt(samples);
  ASSERT_EQ(unlimited.finest_level(), 8);

  parameters.largest_number_of_cells = unlimited.n_cells() / 3;
  AdaptiveBox<2> limited(parameters);
  limited.adaptation.adapt(samples);
  EXPECT_LE(limited.n_cells(), parameters.largest_number_of_cells);
  EXPECT_GT(limited.adaptation.lowered_levels(), 0u);
  EXPECT_EQ(limited.finest_level(), 8 - static_cast<int>(limited.adaptation.lowered_levels()));
  EXPECT_FALSE(limited.adaptation.adapt(samples)) << "the lowered level is kept";
}

TEST(ParallelMeshAdaptation, TheLimitLowersOnlyAsFarAsItMust)
{
  // Far finer levels are allowed than are there: lowering them one by one would change nothing.
  auto parameters = levels(2, 6, 6);
  parameters.finest_level = 12;
  AdaptiveBox<2> unlimited(parameters);
  const auto samples = circle<2>(Point<2>(), 0.45, 2000);
  unlimited.adaptation.adapt(samples);
  ASSERT_EQ(unlimited.finest_level(), 6);
  parameters.largest_number_of_cells = unlimited.n_cells() - 1;
  AdaptiveBox<2> limited(parameters);
  limited.adaptation.adapt(samples);
  EXPECT_LE(limited.n_cells(), parameters.largest_number_of_cells);
  EXPECT_EQ(limited.finest_level(), 5);
  EXPECT_EQ(limited.adaptation.limited(12), 5u);

  // What a restart needs.
  AdaptiveBox<2> restarted(parameters);
  restarted.adaptation.set_lowered_levels(limited.adaptation.lowered_levels());
  restarted.adaptation.adapt(samples);
  EXPECT_EQ(restarted.n_cells(), limited.n_cells());
}

TEST(ParallelMeshAdaptation, CurvatureMakesTheMeshFinerWithHysteresis)
{
  auto parameters = levels(2, 4, 4);
  parameters.curvature_tolerance = 0.5;
  parameters.finest_level = 7;
  AdaptiveBox<2> box(parameters);
  auto samples = circle<2>(Point<2>(), 0.45);
  const auto set_curvature = [&](const double curvature)
  {
    for (auto &sample : samples)
      sample.curvature = sample.point[0] > 0.2 ? curvature : 1.;
  };
  set_curvature(10.); // h = 1/32 for 0.5 / 10
  box.adaptation.adapt(samples);
  EXPECT_EQ(box.finest_level(), 6);
  set_curvature(7.5); // level 5 would do, but not by far
  box.adaptation.adapt(samples);
  EXPECT_EQ(box.finest_level(), 6);
  set_curvature(6.);
  box.adaptation.adapt(samples);
  EXPECT_EQ(box.finest_level(), 5);
  set_curvature(1e5);
  box.adaptation.adapt(samples);
  EXPECT_EQ(box.finest_level(), 7) << "not beyond the finest level";
}

TEST(ParallelMeshAdaptation, CellsAreRefinedKeptAndCoarsenedByTheErrorOfTheFlow)
{
  auto parameters = levels(2, 4, 4);
  parameters.flow_error_tolerance = 0.1;
  parameters.finest_level = 5;
  AdaptiveBox<2> box(parameters);
  const auto samples = circle<2>(Point<2>(-0.5, -0.5), 0.2);
  box.adaptation.adapt(samples);
  const auto is_chosen = [](const auto &cell) { return cell->center()[0] > 0.5 && cell->center()[1] > 0.5; };
  const auto adapt = [&](const double error_in_the_corner)
  {
    std::vector<CellSample<2>> own;
    box.for_owned_cells(
        [&](const auto &cell)
        {
          CellSample<2> sample{};
          sample.center = {{cell->center()[0], cell->center()[1]}};
          sample.level = cell->level();
          sample.error = is_chosen(cell) ? error_in_the_corner : 1e-9;
          own.push_back(sample);
        });
    box.adaptation.adapt(samples, gather_plain(own, MPI_COMM_WORLD));
  };
  const auto levels_in_the_corner = [&]
  {
    std::pair<int, int> range{100, 0};
    box.for_owned_cells(
        [&](const auto &cell)
        {
          if (is_chosen(cell))
            range = {std::min(range.first, cell->level()), std::max(range.second, cell->level())};
        });
    return std::make_pair(Utilities::MPI::min(range.first, MPI_COMM_WORLD),
                          Utilities::MPI::max(range.second, MPI_COMM_WORLD));
  };
  EXPECT_EQ(levels_in_the_corner(), std::make_pair(2, 2));
  adapt(1.);
  EXPECT_EQ(levels_in_the_corner(), std::make_pair(3, 3)) << "one level for each flow";
  adapt(1.);
  adapt(1.);
  adapt(1.);
  EXPECT_EQ(levels_in_the_corner(), std::make_pair(5, 5)) << "not beyond the finest level";
  const double share = 0.1 / std::sqrt(static_cast<double>(box.n_cells()));
  adapt(0.5 * share);
  EXPECT_EQ(levels_in_the_corner(), std::make_pair(5, 5));
  box.adaptation.adapt(samples);
  EXPECT_EQ(levels_in_the_corner(), std::make_pair(5, 5)) << "kept while the flow is not known";
  adapt(0.01 * share);
  EXPECT_EQ(levels_in_the_corner(), std::make_pair(4, 4));
}
