// SPDX-License-Identifier: LGPL-2.1-or-later
// The estimated error of the flow against the exact one.
#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_values.h>

#include <gtest/gtest.h>
#include <iostream>

#include "support/circle_flow.h"
#include "support/flow_on_circle.h"

using namespace dealii;
using namespace Gemmule;
using namespace Gemmule::Testing;

namespace
{
/** Exact gradient by differences of second order, whose error is far below that of the flow. */
Tensor<2, 2> exact_gradient(const CircleFlow &exact, const Point<2> &p)
{
  constexpr double step = 1e-5;
  Tensor<2, 2> gradient; // [component][direction]
  for (unsigned int d = 0; d < 2; ++d)
  {
    Point<2> after = p, before = p;
    after[d] += step;
    before[d] -= step;
    const Tensor<1, 2> difference = (exact.velocity(after) - exact.velocity(before)) / (2. * step);
    for (unsigned int c = 0; c < 2; ++c)
      gradient[c][d] = difference[c];
  }
  return gradient;
}

struct Errors
{
  double exact = 0., estimated = 0.;
};

/** Errors in the energy norm over the cells that the membrane does not cut. */
Errors errors(const unsigned int level, const double viscosity_ratio,
              const std::function<bool(const Point<2> &)> &refine = {})
{
  const Point<2> center(0.0137, 0.0071);
  const CircleFlow exact(center, FlowOnCircle<2>::radius, 2, 0.5, viscosity_ratio);
  FlowOnCircle<2> flow(level, center, viscosity_ratio, refine);
  flow.set_tension([&](const Point<2> &p) { return exact.tension(p); });
  flow.solve(exact);

  const FlowErrorEstimate estimate = flow.solver.estimate_error();
  typename StokesSolver<2>::Vector values;
  flow.solver.interpolate(values);
  const auto &handler = flow.solver.dof_handler();
  const QGauss<2> quadrature(4);
  FEValues<2> fe_values(handler.get_fe(), quadrature,
                        update_gradients | update_quadrature_points | update_JxW_values);
  const FEValuesExtractors::Vector velocity(0);
  std::vector<Tensor<2, 2>> gradients(quadrature.size());
  Errors squares;
  unsigned int k = 0;
  for (const auto &cell : handler.active_cell_iterators())
  {
    if (!cell->is_locally_owned())
      continue;
    const double share = estimate.squares[k++];
    const CellLocation location = flow.geometry.location(cell->active_cell_index());
    if (location == CellLocation::cut)
      continue;
    squares.estimated += share;
    fe_values.reinit(cell);
    fe_values[velocity].get_function_gradients(values, gradients);
    const double eta = location == CellLocation::inside ? viscosity_ratio : 1.;
    for (unsigned int q = 0; q < quadrature.size(); ++q)
    {
      const Tensor<2, 2> e = gradients[q] - exact_gradient(exact, fe_values.quadrature_point(q));
      squares.exact += fe_values.JxW(q) * eta * (scalar_product(e, e) + scalar_product(e, transpose(e)));
    }
  }
  return {std::sqrt(Utilities::MPI::sum(squares.exact, MPI_COMM_WORLD)),
          std::sqrt(Utilities::MPI::sum(squares.estimated, MPI_COMM_WORLD))};
}
} // namespace

TEST(ParallelFlowError, EstimateFollowsTheErrorWithTheMeshAndTheViscosities)
{
  for (const double ratio : {1., 20.})
    for (const bool refined : {false, true})
    {
      const auto refine = [&](const Point<2> &p) { return refined && p[0] > 0.2; };
      const Errors coarse = errors(4, ratio, refine), fine = errors(5, ratio, refine);
      const double effectivity[] = {coarse.estimated / coarse.exact, fine.estimated / fine.exact};
      if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
        std::cout << "viscosity ratio " << ratio << (refined ? ", refined" : ", uniform") << ": error "
                  << coarse.exact << ", " << fine.exact << ", estimated " << coarse.estimated << ", "
                  << fine.estimated << ", effectivity " << effectivity[0] << ", " << effectivity[1] << '\n';
      EXPECT_GT(std::log2(coarse.exact / fine.exact), 1.6);
      for (const double e : effectivity)
      {
        EXPECT_GT(e, 0.5);
        EXPECT_LT(e, 5.);
      }
      EXPECT_NEAR(effectivity[1] / effectivity[0], 1., 0.4);
    }
}

TEST(ParallelFlowError, NormIsTheDissipation)
{
  const Point<2> center(0.0137, 0.0071);
  const CircleFlow exact(center, FlowOnCircle<2>::radius, 2, 0.5, 3.);
  FlowOnCircle<2> flow(4, center, 3.);
  flow.set_tension([&](const Point<2> &p) { return exact.tension(p); });
  flow.solve(exact);
  // Ca = 1: the energy norm squared is (1/2) int eta |grad u + grad u^T|^2
  EXPECT_NEAR(flow.solver.estimate_error().norm_square / flow.solver.viscous_dissipation(), 1., 1e-10);
}
