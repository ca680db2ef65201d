// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/subassembled_matrix.h>

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>
#include <random>

namespace Gemmule
{
namespace
{
  using namespace dealii;

  constexpr unsigned int n_unknowns = 150;

  /** Elements whose dofs are unknowns, sums of up to three of them (hanging nodes), or fixed. */
  class RandomElements
  {
  public:
    explicit RandomElements(const unsigned int seed) : random(seed) {}

    CondensedIndices make(const unsigned int n_local, const bool with_constraints)
    {
      std::vector<unsigned int> numbers(n_unknowns);
      std::iota(numbers.begin(), numbers.end(), 0);
      std::shuffle(numbers.begin(), numbers.end(), random);
      CondensedIndices element;
      for (unsigned int i = 0; i < n_local; ++i)
      {
        const unsigned int n_masters = with_constraints && random() % 3 == 0 ? random() % 4 : 1;
        for (unsigned int m = 0; m < n_masters; ++m)
        {
          element.entries.emplace_back(element.indices.size(), n_masters == 1 ? 1. : number());
          // Dofs of an element share masters.
          element.indices.push_back(with_constraints ? numbers[random() % (n_local + 3)] : numbers[i]);
        }
        element.row_start.push_back(element.entries.size());
        element.inhomogeneities.push_back(0.);
      }
      element.sort();
      return element;
    }

    FullMatrix<double> matrix(const unsigned int n, const bool symmetric)
    {
      FullMatrix<double> a(n, n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          a(i, j) = symmetric && j < i ? a(j, i) : number();
      return a;
    }

    double number() { return std::uniform_real_distribution<double>(-1., 1.)(random); }

  private:
    std::mt19937 random;
  };

  /** += T^T local T, entry by entry. */
  void add_to_dense(const CondensedIndices &element, const FullMatrix<double> &local, const double factor,
                    FullMatrix<double> &dense)
  {
    FullMatrix<double> t(element.n_local(), n_unknowns), product(element.n_local(), n_unknowns);
    for (unsigned int i = 0; i < element.n_local(); ++i)
      for (unsigned int k = element.row_start[i]; k < element.row_start[i + 1]; ++k)
        t(i, element.indices[element.entries[k].first]) += element.entries[k].second;
    local.mmult(product, t);
    product *= factor;
    t.Tmmult(dense, product, true);
  }

  void expect_same(const SubassembledMatrix &matrix, const FullMatrix<double> &dense)
  {
    FullMatrix<double> rest(dense);
    for (unsigned int row = 0; row < matrix.n_rows(); ++row)
      for (std::size_t k = matrix.row_begin(row); k < matrix.row_begin(row + 1); ++k)
      {
        rest(row, matrix.column(k)) -= matrix.entry_values()[k];
        if (matrix.is_symmetric() && matrix.column(k) != row)
          rest(matrix.column(k), row) -= matrix.entry_values()[k];
      }
    EXPECT_LT(rest.linfty_norm(), 1e-12);
  }

  class SubassembledMatrixTest : public testing::TestWithParam<bool>
  {
  };

  TEST_P(SubassembledMatrixTest, IsTheSumOfTheCondensedElements)
  {
    const bool symmetric = GetParam();
    RandomElements random(3);
    SubassembledMatrix matrix(symmetric);
    for (const bool with_constraints : {false, true})
    {
      std::vector<CondensedIndices> elements;
      for (unsigned int e = 0; e < 40; ++e)
        elements.push_back(random.make(e % 14, with_constraints));
      matrix.reinit(std::make_shared<const Utilities::MPI::Partitioner>(n_unknowns), elements);
      for (unsigned int round = 0; round < 2; ++round)
      {
        matrix.set_zero();
        FullMatrix<double> dense(n_unknowns, n_unknowns);
        for (const auto &element : elements)
        {
          const auto local = random.matrix(element.n_local(), symmetric);
          matrix.add(element, local);
          add_to_dense(element, local, 1., dense);
        }
        expect_same(matrix, dense);
      }
    }
  }

  TEST_P(SubassembledMatrixTest, AddsMultiplesOfAMatrix)
  {
    const bool symmetric = GetParam();
    RandomElements random(4);
    const std::vector<CondensedIndices> elements = {random.make(9, false), random.make(12, true)};
    SubassembledMatrix matrix(symmetric);
    matrix.reinit(std::make_shared<const Utilities::MPI::Partitioner>(n_unknowns), elements);
    FullMatrix<double> dense(n_unknowns, n_unknowns);
    for (const auto &element : elements)
      for (const double factor : {2.5, -0.75})
      {
        const auto local = random.matrix(element.n_local(), symmetric);
        matrix.add(element, local, factor);
        add_to_dense(element, local, factor, dense);
      }
    expect_same(matrix, dense);
  }

  TEST_P(SubassembledMatrixTest, IsZeroAfterEachNewPattern)
  {
    RandomElements random(5);
    SubassembledMatrix matrix(GetParam());
    const auto partitioner = std::make_shared<const Utilities::MPI::Partitioner>(n_unknowns);
    for (unsigned int round = 0; round < 3; ++round)
    {
      const std::vector<CondensedIndices> elements = {random.make(10, true), random.make(10, true)};
      matrix.reinit(partitioner, elements);
      expect_same(matrix, FullMatrix<double>(n_unknowns, n_unknowns));
      matrix.add(elements[0], random.matrix(10, true));
    }
  }

  INSTANTIATE_TEST_SUITE_P(OfBothKinds, SubassembledMatrixTest, testing::Bool(),
                           [](const auto &symmetric)
                           { return symmetric.param ? "Symmetric" : "Unsymmetric"; });
} // namespace
} // namespace Gemmule
