// SPDX-License-Identifier: LGPL-2.1-or-later
// Parts of a subassembled matrix for Trilinos, and what approximately inverts them.
#include <gemmule/algebra/chebyshev.h>
#include <gemmule/algebra/linear_system.h>
#include <gemmule/algebra/matrix_part.h>
#include <gemmule/algebra/two_level_cycle.h>

#include <deal.II/base/mpi.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <cmath>
#include <gtest/gtest.h>

namespace Gemmule
{
namespace
{
  using namespace dealii;
  using Index = UnknownPartition::Index;

  /**
   * A chain of nodes with two unknowns each, in a block of their own: the springs between neighbours are
   * 1 + node for the first unknown, 3 + node for the second, and join both with a strength of 0.25. The last
   * node of a rank is joined with the first of the next rank, so that entries of one place are on two ranks.
   */
  struct TwoFields
  {
    explicit TwoFields(const Index n_nodes)
        : n_nodes(n_nodes), rank(Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)),
          n_ranks(Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD)), numbering(MPI_COMM_WORLD),
          system(MPI_COMM_WORLD, true)
    {
      for (unsigned int block = 0; block < 2; ++block)
        numbering.add_field(UnknownPartition({n_nodes}, MPI_COMM_WORLD), {block});
      numbering.close();
      system.begin(numbering);
      for (Index node = rank * n_nodes; node < (rank + 1) * n_nodes; ++node)
        if (node + 1 < n_ranks * n_nodes)
        {
          CondensedIndices element;
          for (unsigned int field = 0; field < 2; ++field)
            for (const Index end : {node, node + 1})
            {
              element.entries.emplace_back(element.indices.size(), 1.);
              element.indices.push_back(numbering.number(field, end));
              element.row_start.push_back(element.entries.size());
              element.inhomogeneities.push_back(0.);
            }
          element.sort();
          system.add_element(std::move(element));
        }
      system.finish_elements();
      system.zero_matrix();
      FullMatrix<double> local(4, 4);
      for (unsigned int e = 0; e < system.n_elements(); ++e)
      {
        for (unsigned int i = 0; i < 4; ++i)
          for (unsigned int j = 0; j < 4; ++j)
            local(i, j) = (i % 2 == j % 2 ? 1. : -1.) * strength(i / 2, j / 2, rank * n_nodes + e);
        system.add_matrix(e, local);
      }
    }

    static double strength(const unsigned int field, const unsigned int other, const Index node)
    {
      return field != other ? 0.25 : (field == 0 ? 1. : 3.) + node;
    }

    /** An entry of the whole matrix: of @p field at @p node and @p other at @p neighbour. */
    double entry(const unsigned int field, const Index node, const unsigned int other,
                 const Index neighbour) const
    {
      if (node == neighbour)
        return (node > 0 ? strength(field, other, node - 1) : 0.) +
               (node + 1 < n_ranks * n_nodes ? strength(field, other, node) : 0.);
      return std::max(node, neighbour) - std::min(node, neighbour) == 1
                 ? -strength(field, other, std::min(node, neighbour))
                 : 0.;
    }

    /** (field, node) of each row of this rank's matrix. */
    std::vector<std::pair<unsigned int, Index>> places() const
    {
      std::vector<std::pair<unsigned int, Index>> result;
      for (unsigned int row = 0; row < system.matrix().n_rows(); ++row)
        result.push_back(numbering.block_index(system.matrix().partitioner()->local_to_global(row)));
      return result;
    }

    const Index n_nodes, rank, n_ranks;
    BlockNumbering numbering;
    LinearSystem system;
  };

  template <typename Exact>
  void expect_matrix(const TrilinosWrappers::SparseMatrix &matrix, const TwoFields &fields,
                     const Exact &exact)
  {
    const Index n = fields.n_nodes * fields.n_ranks;
    ASSERT_EQ(matrix.m(), n);
    ASSERT_EQ(matrix.n(), n);
    for (Index row = fields.rank * fields.n_nodes; row < (fields.rank + 1) * fields.n_nodes; ++row)
      for (Index column = 0; column < n; ++column)
        EXPECT_DOUBLE_EQ(matrix.el(row, column), exact(row, column)) << row << ", " << column;
  }

  TEST(ParallelMatrixPart, ASymmetricPartIsTheWeightedSumOfItsGroups)
  {
    const TwoFields fields(5);
    MatrixPart part;
    for (const auto &[field, node] : fields.places())
      part.rows.push_back({field, node});
    part.owned_rows = fields.numbering.locally_owned_in_block(0);
    TrilinosWrappers::SparseMatrix matrix;
    extract_part({{&fields.system.matrix(), 0.5}}, part, MPI_COMM_WORLD, matrix);
    expect_matrix(matrix, fields,
                  [&](const Index row, const Index column)
                  { return 0.5 * (fields.entry(0, row, 0, column) + fields.entry(1, row, 1, column)); });
  }

  TEST(ParallelMatrixPart, SeveralMatricesAreAddedWithTheirWeights)
  {
    const TwoFields fields(4);
    MatrixPart part;
    for (const auto &[field, node] : fields.places())
      part.rows.push_back({field == 1 ? 0 : numbers::invalid_unsigned_int, node});
    part.owned_rows = fields.numbering.locally_owned_in_block(1);
    TrilinosWrappers::SparseMatrix matrix;
    extract_part({{&fields.system.matrix(), 2.}, {&fields.system.matrix(), -0.5}}, part, MPI_COMM_WORLD,
                 matrix);
    expect_matrix(matrix, fields,
                  [&](const Index row, const Index column) { return 1.5 * fields.entry(1, row, 1, column); });
  }

  TEST(ParallelMatrixPart, APartOffTheDiagonalHasBothStoredAndMirroredEntries)
  {
    const TwoFields fields(5);
    for (const unsigned int row_field : {0u, 1u}) // one of them is stored, the other one its mirror image
    {
      MatrixPart part;
      for (const auto &[field, node] : fields.places())
      {
        part.rows.push_back({field == row_field ? 0 : numbers::invalid_unsigned_int, node});
        part.columns.push_back({field == row_field ? numbers::invalid_unsigned_int : 0, node});
      }
      part.owned_rows = part.owned_columns = fields.numbering.locally_owned_in_block(0);
      TrilinosWrappers::SparseMatrix matrix;
      extract_part({{&fields.system.matrix(), 1.}}, part, MPI_COMM_WORLD, matrix);
      expect_matrix(matrix, fields,
                    [&](const Index row, const Index column)
                    { return fields.entry(row_field, row, 1 - row_field, column); });
    }
  }

  /** -u'' on a chain with walls at both ends. */
  TrilinosWrappers::SparseMatrix laplacian(const Index n_per_rank)
  {
    const IndexSet owned = UnknownPartition({n_per_rank}, MPI_COMM_WORLD)
                               .owned(Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
    TrilinosWrappers::SparsityPattern pattern(owned, owned, MPI_COMM_WORLD);
    const auto for_all = [&](const auto &action)
    {
      for (const Index row : owned)
      {
        action(row, row, 2.);
        if (row > 0)
          action(row, row - 1, -1.);
        if (row + 1 < owned.size())
          action(row, row + 1, -1.);
      }
    };
    for_all([&](const Index row, const Index column, double) { pattern.add(row, column); });
    pattern.compress();
    TrilinosWrappers::SparseMatrix matrix(pattern);
    for_all([&](const Index row, const Index column, const double value) { matrix.set(row, column, value); });
    matrix.compress(VectorOperation::insert);
    return matrix;
  }

  double norm(const Epetra_MultiVector &x)
  {
    double result = 0.;
    x.Norm2(&result);
    return result;
  }

  TEST(ParallelChebyshev, TheLargestEigenvalueIsFoundFromBelowWithSomeMargin)
  {
    const auto matrix = laplacian(40);
    const Chebyshev chebyshev(matrix.trilinos_matrix(), 3, 10.);
    // D^-1 A has eigenvalues 1 - cos, up to nearly 2.
    EXPECT_GT(chebyshev.upper_end(), 2. * 0.95);
    EXPECT_LT(chebyshev.upper_end(), 2. * 1.15);
  }

  TEST(ParallelChebyshev, WavesInTheIntervalAreDampedByTheChebyshevPolynomial)
  {
    const auto matrix = laplacian(40);
    const auto &map = matrix.trilinos_matrix().RowMap();
    const double n = map.NumGlobalElements64(), ratio = 6.;
    const unsigned int degree = 4;
    const Chebyshev chebyshev(matrix.trilinos_matrix(), degree, ratio);
    // Two waves at once, as columns; of both the exact solution is zero, so that x is the error.
    Epetra_MultiVector x(map, 2), residual(map, 2);
    const std::array<double, 2> wave{{0.9 * n, 0.5 * n}};
    std::array<double, 2> eigenvalue;
    for (unsigned int c = 0; c < 2; ++c)
    {
      const double k = numbers::PI * std::round(wave[c]) / (n + 1.);
      eigenvalue[c] = 1. - std::cos(k);
      for (int i = 0; i < x.MyLength(); ++i)
        x[c][i] = std::sin(k * (map.GID64(i) + 1.));
    }
    matrix.trilinos_matrix().Multiply(false, x, residual);
    residual.Scale(-1.);
    std::array<double, 2> before, after, of_residual;
    x.Norm2(before.data());
    chebyshev.smooth(residual, x, /*update_residual =*/true);
    x.Norm2(after.data());
    const double center = 0.5 * (1. + 1. / ratio), radius = 0.5 * (1. - 1. / ratio);
    const auto polynomial = [&](const double t)
    { return std::abs(t) <= 1. ? std::cos(degree * std::acos(t)) : std::cosh(degree * std::acosh(t)); };
    for (unsigned int c = 0; c < 2; ++c)
    {
      const double t = (center - eigenvalue[c] / chebyshev.upper_end()) / radius;
      const double factor = std::abs(polynomial(t)) / polynomial(center / radius);
      EXPECT_NEAR(after[c] / before[c], factor, 1e-12) << "wave " << c;
      EXPECT_LT(factor, 1. / polynomial(center / radius) + 1e-12);
    }
    // The residual is that of the new x.
    Epetra_MultiVector expected(map, 2);
    matrix.trilinos_matrix().Multiply(false, x, expected);
    expected.Update(1., residual, 1.);
    expected.Norm2(of_residual.data());
    EXPECT_LT(of_residual[0] + of_residual[1], 1e-13);
  }

  TEST(ParallelTwoLevelCycle, ItReducesTheErrorOfAnyLengthAndSolvesColumnsAlike)
  {
    const Index n_per_rank = 60;
    const auto matrix = laplacian(n_per_rank);
    const auto &map = matrix.trilinos_matrix().RowMap();
    // Every other point is a coarse one.
    const IndexSet fine = matrix.locally_owned_range_indices();
    const IndexSet coarse = UnknownPartition({n_per_rank / 2}, MPI_COMM_WORLD)
                                .owned(Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
    TrilinosWrappers::SparsityPattern pattern(fine, coarse, MPI_COMM_WORLD);
    const auto for_all = [&](const auto &action)
    {
      for (const Index row : fine)
        if (row % 2 == 1)
          action(row, row / 2, 1.);
        else
        {
          action(row, row / 2, 0.5);
          if (row > 0)
            action(row, row / 2 - 1, 0.5);
        }
    };
    for_all([&](const Index row, const Index column, double) { pattern.add(row, column); });
    pattern.compress();
    TrilinosWrappers::SparseMatrix prolongation(pattern);
    for_all([&](const Index row, const Index column, const double value)
            { prolongation.set(row, column, value); });
    prolongation.compress(VectorOperation::insert);

    const TwoLevelCycle cycle(matrix, prolongation);
    EXPECT_GE(cycle.n_coarse_levels(), 1u);
    for (const double wave : {1., 7., 31., 59., 90.})
    {
      Epetra_MultiVector exact(map, 2), right_side(map, 2), x(map, 2);
      for (int i = 0; i < exact.MyLength(); ++i)
      {
        exact[0][i] = std::sin(wave * numbers::PI * (map.GID64(i) + 1.) / (map.NumGlobalElements64() + 1.));
        exact[1][i] = -2. * exact[0][i];
      }
      matrix.trilinos_matrix().Multiply(false, exact, right_side);
      cycle.apply(right_side, x);
      Epetra_Vector first(*x(0)), second(*x(1));
      second.Update(2., first, 1.);
      EXPECT_LT(norm(second), 1e-12 * norm(first));
      first.Update(-1., *exact(0), 1.);
      EXPECT_LT(norm(first), 0.2 * norm(*exact(0))) << "wave " << wave;
    }
  }
} // namespace
} // namespace Gemmule
