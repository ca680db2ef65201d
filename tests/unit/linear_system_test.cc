// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/block_view.h>
#include <gemmule/algebra/linear_system.h>
#include <gemmule/base/exceptions.h>

#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

namespace Gemmule
{
namespace
{
  using namespace dealii;
  using Index = UnknownPartition::Index;

  constexpr Index n_per_rank = 7;

  /**
   * -u'' = 0 on a chain of points with the values 0 and 1 at its ends, which are inhomogeneous constraints:
   * the elements are the pairs of neighbours, and the last of a rank reaches to the next rank.
   */
  struct Chain
  {
    explicit Chain(const bool symmetric)
        : rank(Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)),
          n_ranks(Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD)), system(MPI_COMM_WORLD, symmetric)
    {
      BlockNumbering numbering(MPI_COMM_WORLD);
      numbering.add_field(UnknownPartition({3, n_per_rank - 3}, MPI_COMM_WORLD), {0, 1});
      numbering.close();
      system.begin(numbering);
      const Index begin = rank * n_per_rank, n = n_ranks * n_per_rank;
      for (Index i = begin; i < begin + n_per_rank; ++i)
      {
        if (i == 0)
          add_element({}, 0., {0}); // the wall at the left
        if (i + 1 == n)
          add_element({i}, 0., {}, 1.); // the wall at the right
        else
          add_element({i}, 0., {i + 1});
      }
      system.finish_elements();
    }

    /** An element of two dofs; without an unknown a dof has the given value. */
    void add_element(const std::vector<Index> &left, const double left_value, const std::vector<Index> &right,
                     const double right_value = 0.)
    {
      CondensedIndices element;
      for (const auto &[dof, value] : {std::make_pair(left, left_value), std::make_pair(right, right_value)})
      {
        if (!dof.empty())
        {
          element.entries.emplace_back(element.indices.size(), 1.);
          element.indices.push_back(dof[0]);
        }
        element.row_start.push_back(element.entries.size());
        element.inhomogeneities.push_back(dof.empty() ? value : 0.);
      }
      element.sort();
      system.add_element(std::move(element));
    }

    LinearSystem::Vector assemble(const double stiffness)
    {
      FullMatrix<double> local(2, 2);
      local(0, 0) = local(1, 1) = stiffness;
      local(0, 1) = local(1, 0) = -stiffness;
      auto right_side = system.make_vector();
      system.zero_matrix();
      for (unsigned int e = 0; e < system.n_elements(); ++e)
      {
        system.add_matrix(e, local);
        system.add_inhomogeneity(e, local, right_side);
      }
      return right_side;
    }

    double exact(const Index i) const { return (i + 1.) / (n_ranks * n_per_rank + 1.); }

    unsigned int rank, n_ranks;
    LinearSystem system;
  };

  TEST(ParallelLinearSystem, SolvesAcrossRanksWithInhomogeneousConstraints)
  {
    for (const bool symmetric : {true, false})
    {
      Chain chain(symmetric);
      for (const double stiffness : {1., 3.}) // the second time with the pattern of the first
      {
        auto right_side = chain.assemble(stiffness);
        chain.system.factorise();
        const auto solution = chain.system.solve(std::move(right_side));
        for (const auto i : solution.locally_owned_elements())
          EXPECT_NEAR(solution(i), chain.exact(i), 1e-13);
        // and the neighbour on the next rank is there
        if (chain.rank + 1 < chain.n_ranks)
        {
          std::array<double, 2> local;
          chain.system.gather(chain.system.n_elements() - 1, solution, local.data());
          EXPECT_NEAR(local[1], chain.exact((chain.rank + 1) * n_per_rank), 1e-13);
        }
      }
    }
  }

  TEST(ParallelLinearSystem, SolvesForSeveralRightSidesAtOnce)
  {
    Chain chain(true);
    const auto right_side = chain.assemble(1.);
    chain.system.factorise();
    std::vector<LinearSystem::Vector> right_sides(3, chain.system.make_vector()),
        solutions(3, chain.system.make_vector());
    for (unsigned int c = 0; c < 3; ++c)
    {
      auto complete = right_side;
      complete.compress(VectorOperation::add);
      right_sides[c].add(c + 1., complete);
    }
    chain.system.solve(right_sides, solutions);
    for (unsigned int c = 0; c < 3; ++c)
      for (const auto i : solutions[c].locally_owned_elements())
        EXPECT_NEAR(solutions[c](i), (c + 1.) * chain.exact(i), 1e-13);
  }

  TEST(ParallelLinearSystem, MultipliesWithTheMatrixThatItSolvesWith)
  {
    for (const bool symmetric : {true, false})
    {
      Chain chain(symmetric);
      auto right_side = chain.assemble(2.);
      chain.system.factorise();
      const auto solution = chain.system.solve(right_side);
      right_side.compress(VectorOperation::add);
      const auto product = chain.system.vmult(solution);
      for (const auto i : product.locally_owned_elements())
        EXPECT_NEAR(product(i), right_side(i), 1e-13);
    }
  }

  TEST(ParallelLinearSystem, IsTheSameMatrixByBlocksInTrilinos)
  {
    for (const bool symmetric : {true, false})
    {
      Chain chain(symmetric);
      chain.assemble(2.);
      const BlockView view(chain.system);
      EXPECT_EQ(view.matrix().n_block_rows(), 2u);
      EXPECT_EQ(view.matrix().block(0, 0).m(), 3u * chain.n_ranks);
      auto x = chain.system.make_vector();
      for (const auto i : x.locally_owned_elements())
        x(i) = std::sin(1. + i);
      auto by_blocks = view.make_vector();
      view.matrix().vmult(by_blocks, view.to_blocks(x));
      auto product = chain.system.make_vector();
      view.from_blocks(by_blocks, product);
      x.update_ghost_values();
      product -= chain.system.vmult(x);
      EXPECT_LT(product.linfty_norm(), 1e-14);
    }
  }

  TEST(ParallelLinearSystem, KeepsThePatternAsLongAsTheElementsStay)
  {
    Chain chain(true);
    const unsigned int version = chain.system.matrix().pattern_version();
    EXPECT_GT(version, 0u);
    auto element = [](const Index a)
    {
      CondensedIndices e;
      e.indices = {a};
      e.entries = {{0, 1.}};
      e.row_start = {0, 1};
      e.inhomogeneities = {0.};
      return e;
    };
    const BlockNumbering numbering = chain.system.numbering();
    for (unsigned int round = 0; round < 2; ++round)
    {
      chain.system.begin(numbering);
      chain.system.add_element(element(chain.rank * n_per_rank));
      chain.system.finish_elements();
      EXPECT_EQ(chain.system.matrix().pattern_version(), version + 1);
    }
  }

  TEST(ParallelLinearSystem, SaysOnAllRanksThatAMatrixIsSingular)
  {
    Chain chain(true);
    chain.system.zero_matrix();
    EXPECT_THROW(chain.system.factorise(), SimulationError);
  }
} // namespace
} // namespace Gemmule
