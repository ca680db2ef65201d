// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/cut_cell_matrix.h>

#include <deal.II/fe/fe_q.h>

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace Gemmule
{
namespace
{
  using namespace dealii;

  double random_number(std::mt19937 &random, const double from, const double to)
  {
    return std::uniform_real_distribution<double>(from, to)(random);
  }

  template <int dim>
  Point<dim> random_point(std::mt19937 &random, const double extent)
  {
    Point<dim> p;
    for (unsigned int d = 0; d < dim; ++d)
      p[d] = random_number(random, 0., extent);
    return p;
  }

  template <typename T>
  class CutCellIntegralsTest : public testing::Test
  {
  public:
    static constexpr int dim = T::value;
  };
  using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
  TYPED_TEST_SUITE(CutCellIntegralsTest, Dimensions, );

  TYPED_TEST(CutCellIntegralsTest, OfPolynomialsOfDegreeFourAreThoseOfTheGridRule)
  {
    constexpr int dim = TestFixture::dim;
    std::mt19937 random(1);
    GridRule<dim> rule;
    std::vector<Point<dim>> points;
    std::vector<double> weights;
    typename GridRule<dim>::Weights grid_weights;
    for (unsigned int q = 0; q < 30; ++q)
    {
      points.push_back(random_point<dim>(random, 1.));
      weights.push_back(random_number(random, 0., 1.));
      GridRule<dim>::evaluate(points[q], grid_weights);
      rule.add(grid_weights, weights[q]);
    }
    const auto monomial = [](const Point<dim> &p, unsigned int powers)
    {
      double value = 1.;
      for (unsigned int d = 0; d < dim; ++d, powers /= 5)
        value *= std::pow(p[d], powers % 5);
      return value;
    };
    for (unsigned int powers = 0; powers < GridRule<dim>::n; ++powers)
    {
      double expected = 0., sum = 0.;
      for (unsigned int q = 0; q < points.size(); ++q)
        expected += weights[q] * monomial(points[q], powers);
      for (unsigned int k = 0; k < GridRule<dim>::n; ++k)
      {
        Point<dim> node;
        for (unsigned int d = 0, r = k; d < dim; ++d, r /= 5)
          node[d] = GridRule<dim>::nodes()[r % 5];
        sum += rule.weights()[k] * monomial(node, powers);
      }
      EXPECT_NEAR(sum, expected, 1e-13);
    }
  }

  /** A cut cell with any points: its matrix is a sum over them, whatever membrane they belong to. */
  template <int dim>
  CutCell<dim> random_cut_cell(std::mt19937 &random, const double extent)
  {
    CutCell<dim> cell;
    cell.size = 0.125;
    const double measure = std::pow(extent * cell.size, dim);
    for (unsigned int fluid = 0; fluid < 2; ++fluid)
      for (unsigned int q = 0; q < 5 + 3 * fluid; ++q)
      {
        cell.bulk_points[fluid].push_back(random_point<dim>(random, fluid == 0 ? extent : 1.));
        cell.bulk_weights[fluid].push_back(random_number(random, 0., fluid == 0 ? measure : 1e-2));
      }
    for (unsigned int q = 0; q < 4; ++q)
    {
      cell.surface_points.push_back(random_point<dim>(random, extent));
      cell.surface_weights.push_back(random_number(random, 0., measure / extent));
      const Tensor<1, dim> n = random_point<dim>(random, 1.) - Point<dim>::unit_vector(0);
      cell.normals.push_back(n / n.norm());
    }
    return cell;
  }

  /** One shape of the doubled space at a point, in physical coordinates. */
  template <int dim>
  struct VectorShape
  {
    unsigned int fluid;
    Tensor<1, dim> u;
    Tensor<2, dim> gradient; ///< [component][derivative]
    double p = 0.;

    double divergence() const { return trace(gradient); }
    Tensor<2, dim> rate() const { return 0.5 * (gradient + transpose(gradient)); }
  };

  template <int dim>
  class Shapes
  {
  public:
    VectorShape<dim> operator()(const unsigned int local, const Point<dim> &point, const double h) const
    {
      using Layout = StokesLayout<dim>;
      VectorShape<dim> shape;
      shape.fluid = local / Layout::n;
      const unsigned int i = local % Layout::n;
      if (i < Layout::n_velocity)
      {
        const unsigned int c = i / Layout::n_velocity_nodes;
        const unsigned int dof = dof_at(quadratic, Layout::VelocityBasis::node(i % Layout::n_velocity_nodes));
        shape.u[c] = quadratic.shape_value(dof, point);
        shape.gradient[c] = quadratic.shape_grad(dof, point) / h;
      }
      else
        shape.p =
            linear.shape_value(dof_at(linear, Layout::PressureBasis::node(i - Layout::n_velocity)), point);
      return shape;
    }

  private:
    static unsigned int dof_at(const FE_Q<dim> &fe, const Point<dim> &node)
    {
      unsigned int dof = 0;
      while (fe.unit_support_point(dof).distance(node) > 1e-10)
        ++dof;
      return dof;
    }

    const FE_Q<dim> quadratic{2}, linear{1};
  };

  /** The bilinear form of doc/method-flow.md, point by point. */
  template <int dim>
  FullMatrix<double> sum_over_points(const CutCell<dim> &cell, const FluidPair &fluids, const double gamma)
  {
    constexpr unsigned int n = CutCellMatrix<dim>::n;
    FullMatrix<double> matrix(n, n);
    const Shapes<dim> shapes;
    std::vector<VectorShape<dim>> at_point(n);
    const auto evaluate = [&](const Point<dim> &point)
    {
      for (unsigned int i = 0; i < n; ++i)
        at_point[i] = shapes(i, point, cell.size);
    };
    for (unsigned int fluid = 0; fluid < 2; ++fluid)
      for (unsigned int q = 0; q < cell.bulk_points[fluid].size(); ++q)
      {
        evaluate(cell.bulk_points[fluid][q]);
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
            if (const auto &v = at_point[i], &u = at_point[j]; v.fluid == fluid && u.fluid == fluid)
              matrix(i, j) += cell.bulk_weights[fluid][q] *
                              (2. * fluids.viscosity[fluid] * scalar_product(u.rate(), v.rate()) -
                               u.p * v.divergence() - v.p * u.divergence());
      }
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      evaluate(cell.surface_points[q]);
      const Tensor<1, dim> normal = cell.normals[q];
      const auto mean_traction = [&](const VectorShape<dim> &s)
      {
        return fluids.stress_weight[s.fluid] *
               (2. * fluids.viscosity[s.fluid] * s.rate() * normal - s.p * normal);
      };
      const auto jump = [](const VectorShape<dim> &s) { return s.fluid == 0 ? -s.u : s.u; };
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          matrix(i, j) += cell.surface_weights[q] * (mean_traction(at_point[j]) * jump(at_point[i]) +
                                                     mean_traction(at_point[i]) * jump(at_point[j]) +
                                                     gamma * fluids.interface_viscosity / cell.size *
                                                         jump(at_point[i]) * jump(at_point[j]));
    }
    return matrix;
  }

  TYPED_TEST(CutCellIntegralsTest, MakeTheMatrixOfTheCell)
  {
    constexpr int dim = TestFixture::dim;
    constexpr unsigned int n = CutCellMatrix<dim>::n;
    std::mt19937 random(2);
    FullMatrix<double> matrix(n, n);
    for (const double viscosity_ratio : {1., 0.01, 50.})
    {
      const FluidPair fluids(viscosity_ratio);
      CutCellMatrix<dim> cut_cell_matrix(fluids, 40.);
      const auto cell = random_cut_cell<dim>(random, 1.);
      cut_cell_matrix.compute(cell, matrix);
      const auto expected = sum_over_points(cell, fluids, 40.);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
        {
          EXPECT_NEAR(matrix(i, j), expected(i, j), 1e-12 * expected.linfty_norm()) << i << ' ' << j;
          EXPECT_EQ(matrix(i, j), matrix(j, i));
        }
    }
  }

  TYPED_TEST(CutCellIntegralsTest, AreAccurateForSliversRelativeToTheirSize)
  {
    constexpr int dim = TestFixture::dim;
    std::mt19937 random(3);
    for (const double extent : {1e-3, 1e-7})
    {
      CutCell<dim> cell = random_cut_cell<dim>(random, extent);
      const FluidPair fluids(1.);
      CutCellMatrix<dim> cut_cell_matrix(fluids, 40.);
      cell.surface_points.clear();
      cell.bulk_points[1].clear(); // the sliver alone
      FullMatrix<double> matrix(CutCellMatrix<dim>::n, CutCellMatrix<dim>::n);
      cut_cell_matrix.compute(cell, matrix);
      auto expected = sum_over_points(cell, fluids, 40.);
      const double size = expected.linfty_norm();
      expected.add(-1., matrix);
      EXPECT_LT(expected.linfty_norm(), 1e-12 * size);
    }
  }
} // namespace
} // namespace Gemmule
