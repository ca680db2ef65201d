// SPDX-License-Identifier: LGPL-2.1-or-later
// How cells are divided among ranks, by counting what each of them has.
#include <gemmule/base/gather.h>
#include <gemmule/mesh/load_balance.h>
#include <gemmule/mesh/mesh_adaptation.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>
#include <deal.II/grid/grid_generator.h>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>

using namespace Gemmule;
using namespace dealii;

namespace
{
constexpr unsigned int bulk_level = 3, membrane_level = 5;

/** The box [-1, 1]^dim as a run has it. */
template <int dim>
std::unique_ptr<parallel::distributed::Triangulation<dim>> box(const unsigned int level)
{
  using Mesh = parallel::distributed::Triangulation<dim>;
  auto mesh = std::make_unique<Mesh>(MPI_COMM_WORLD, Triangulation<dim>::MeshSmoothing::none,
                                     Mesh::mesh_reconstruction_after_repartitioning);
  GridGenerator::hyper_cube(*mesh, -1., 1.);
  mesh->refine_global(level);
  return mesh;
}

/** A circle or sphere in a corner of the box, moved to the right by @p shift after the first time level. */
template <int dim>
struct Membrane
{
  Point<dim> center;
  double radius = 0.3, shift = 0.;

  explicit Membrane(const double shift = 0.) : shift(shift)
  {
    for (unsigned int d = 0; d < dim; ++d)
      center[d] = -0.513 - 0.021 * d;
  }

  std::vector<MembraneSample<dim>> samples() const
  {
    std::vector<MembraneSample<dim>> result;
    const unsigned int n = dim == 2 ? 1000 : 20000;
    for (unsigned int i = 0; i < n; ++i)
    {
      Tensor<1, dim> direction;
      if constexpr (dim == 2)
        direction = Tensor<1, 2>({std::cos(2. * numbers::PI * i / n), std::sin(2. * numbers::PI * i / n)});
      else
      {
        // Along a spiral from pole to pole.
        const double z = 1. - (2. * i + 1.) / n, rho = std::sqrt(1. - z * z), angle = 2.399963229728653 * i;
        direction = Tensor<1, 3>({rho * std::cos(angle), rho * std::sin(angle), z});
      }
      MembraneSample<dim> sample;
      sample.point = center + radius * direction;
      result.push_back(sample);
      if (shift != 0.)
      {
        sample.point[0] += shift;
        sample.time_level = 1;
        result.push_back(sample);
      }
    }
    return result;
  }

  /** At its last place, by the signs of a lattice of points of the cell. */
  template <typename Cell>
  bool cuts(const Cell &cell) const
  {
    const double h = cell->extent_in_direction(0);
    const unsigned int n = 9;
    bool inside = false, outside = false;
    for (unsigned int i = 0; i < std::pow(n, dim); ++i)
    {
      Point<dim> x = cell->vertex(0);
      for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n)
        x[d] += h * (rest % n) / (n - 1.);
      x[0] -= shift;
      (x.distance(center) < radius ? inside : outside) = true;
    }
    return inside && outside;
  }
};

/** What a rank has more than the mean of all of them, in parts of the mean. */
double excess(const double of_this_rank)
{
  const auto values = Utilities::MPI::min_max_avg(of_this_rank, MPI_COMM_WORLD);
  return values.max / values.avg - 1.;
}

/** A cell that the membrane cuts is as much work as ten others. */
template <int dim>
double excess_of_work(const parallel::distributed::Triangulation<dim> &mesh, const Membrane<dim> &membrane)
{
  unsigned int work = 0;
  for (const auto &cell : mesh.active_cell_iterators())
    if (cell->is_locally_owned())
      work += membrane.cuts(cell) ? 10 : 1;
  return excess(work);
}

Parameters::Mesh levels()
{
  Parameters::Mesh parameters;
  parameters.bulk_level = bulk_level;
  parameters.membrane_level = parameters.phase_boundary_level = membrane_level;
  parameters.cells_per_gap = parameters.curvature_tolerance = 0.;
  return parameters;
}

/** The cells of this rank, in their order. */
template <int dim>
std::vector<std::vector<unsigned int>> owned(const parallel::distributed::Triangulation<dim> &mesh)
{
  const BoxLattice<dim> lattice(mesh);
  std::vector<std::vector<unsigned int>> cells;
  for (const auto &cell : mesh.active_cell_iterators())
    if (cell->is_locally_owned())
    {
      const auto key = lattice.position_of_corner(cell->vertex(0), cell->level());
      cells.emplace_back(key.begin(), key.end());
      cells.back().push_back(cell->level());
    }
  return cells;
}

template <int dim>
void expect_work_to_be_shared(const double shift, const double excess_by_number)
{
  const Membrane<dim> membrane(shift);
  auto mesh = box<dim>(bulk_level);
  MeshAdaptation<dim> adaptation(*mesh, levels());
  EXPECT_TRUE(adaptation.load_balance().membrane_cells().empty());
  ASSERT_TRUE(adaptation.adapt(membrane.samples()));
  EXPECT_LT(excess_of_work(*mesh, membrane), 0.1);

  // By number of cells alone they would not be.
  const auto membrane_cells = adaptation.load_balance().membrane_cells();
  EXPECT_FALSE(membrane_cells.empty());
  adaptation.load_balance().divide_by({});
  EXPECT_LT(excess(mesh->n_locally_owned_active_cells()), 0.05);
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
  {
    EXPECT_GT(excess_of_work(*mesh, membrane), excess_by_number);
  }
  adaptation.load_balance().divide_by(membrane_cells);
  EXPECT_LT(excess_of_work(*mesh, membrane), 0.1);
}
} // namespace

TEST(ParallelLoadBalance, TheRanksShareTheWorkOfTheCellsThatTheMembraneCuts)
{
  expect_work_to_be_shared<2>(0., 0.1);
  expect_work_to_be_shared<3>(0., 0.1);
}

TEST(ParallelLoadBalance, WhereTheMembraneWillBeCounts)
{
  expect_work_to_be_shared<2>(1., 0.2);
}

// A resumed run takes another way to its mesh.
TEST(ParallelLoadBalance, TheDivisionDoesNotDependOnWhatTheMeshWasBefore)
{
  auto mesh = box<2>(bulk_level);
  MeshAdaptation<2> adaptation(*mesh, levels());
  adaptation.adapt(Membrane<2>(0.5).samples());
  adaptation.adapt(Membrane<2>().samples());
  const auto cells = gather_mesh_cells(*mesh);

  auto other_mesh = box<2>(bulk_level);
  MeshAdaptation<2> other(*other_mesh, levels());
  refine_to_cells(*other_mesh, cells);
  other.load_balance().divide_by(adaptation.load_balance().membrane_cells());
  EXPECT_EQ(owned(*other_mesh), owned(*mesh));

  // Nor does dividing it once more change anything.
  adaptation.load_balance().divide();
  EXPECT_EQ(owned(*mesh), owned(*other_mesh));
  EXPECT_FALSE(adaptation.adapt(Membrane<2>().samples()));
  EXPECT_EQ(owned(*mesh), owned(*other_mesh));
}

TEST(LoadBalance, OnOneRankItLeavesTheMeshAlone)
{
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
    GTEST_SKIP() << "for one rank";
  auto mesh = box<2>(bulk_level);
  unsigned int n_changes = 0;
  mesh->signals.any_change.connect([&] { ++n_changes; });
  LoadBalance<2> balance(*mesh);
  balance.divide_by({{bulk_level, {{1, 2}}}});
  balance.divide();
  EXPECT_EQ(n_changes, 0u);
}

TEST(ParallelLoadBalance, ThereMayBeMoreWeightInOneCellThanInAllOthers)
{
  auto mesh = box<2>(1);
  LoadBalance<2> balance(*mesh);
  balance.divide_by({{7, {{0, 0}}}});
  EXPECT_EQ(mesh->n_global_active_cells(), 4u);
  EXPECT_EQ(Utilities::MPI::sum(mesh->n_locally_owned_active_cells(), MPI_COMM_WORLD), 4u);
}
