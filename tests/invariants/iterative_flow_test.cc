// SPDX-License-Identifier: LGPL-2.1-or-later
// The iterative solver of the flow finds what the direct one finds, in few iterations.
#include <gemmule/base/exceptions.h>
#include <gemmule/flow/arclength_constraint.h>
#include <gemmule/flow/flow_system_solver.h>
#include <gemmule/flow/iterative_flow_solver.h>
#include <gemmule/flow/semi_implicit_bending.h>

#include <cstdlib>
#include <gtest/gtest.h>
#include <numeric>
#include <string>

#include "support/flow_on_circle.h"

namespace Gemmule::Testing
{
namespace
{
  template <int dim>
  struct BothSolvers : FlowOnCircle<dim>
  {
    BothSolvers(const unsigned int level, const Point<dim> &center, const double viscosity_ratio,
                const std::function<bool(const Point<dim> &)> &refine = {}, const double tolerance = 1e-8,
                const unsigned int largest_number = 200)
        : FlowOnCircle<dim>(level, center, viscosity_ratio, refine),
          linear_solver(new IterativeFlowSolver(tolerance, largest_number)),
          iterative(this->mesh.triangulation, this->fluid, Parameters::Flow(),
                    std::unique_ptr<LinearSolver>(linear_solver))
    {
      iterative.reinit_mesh();
      this->set_tension([](const Point<dim> &p) { return 1. + 0.5 * p[0] / p.norm(); });
    }

    typename StokesSolver<dim>::Terms terms() const
    {
      auto all = more_terms;
      all.push_back(std::make_shared<TensionForce<dim>>(this->tension, this->fluid.capillary_number));
      return all;
    }

    void solve_iteratively(const Function<dim> &walls = Functions::ZeroFunction<dim>(dim))
    {
      iterative.prepare(this->geometry, walls, terms());
      iterative.solve();
    }

    /** The largest difference of <u> on the membrane between both, by the largest velocity. */
    double difference(const Function<dim> &walls = Functions::ZeroFunction<dim>(dim))
    {
      this->solve(walls, more_terms);
      double largest = 0.;
      for (unsigned int k = 0; k < this->geometry.cut_cells().size(); ++k)
        for (const auto &point : this->geometry.cut_cells()[k].surface_points)
          largest = std::max(largest, (iterative.membrane_velocity()[k].value(point) -
                                       this->solver.membrane_velocity()[k].value(point))
                                          .norm());
      return Utilities::MPI::max(largest, MPI_COMM_WORLD) / this->solver.max_velocity();
    }

    unsigned int n_iterations() const { return linear_solver->iterations()[0]; }

    typename StokesSolver<dim>::Terms more_terms;
    IterativeFlowSolver *linear_solver;
    StokesSolver<dim> iterative;
  };

  const Point<2> off_the_grid(0.013, 0.007);

  /** With GEMMULE_PRINT_ITERATIONS in the environment it prints what it finds. */
  template <int dim>
  void expect_the_same_flow(BothSolvers<dim> &flow, const unsigned int most_iterations,
                            const std::string &name)
  {
    flow.solve_iteratively();
    const double difference = flow.difference();
    EXPECT_LT(difference, 1e-5) << name;
    EXPECT_LE(flow.n_iterations(), most_iterations) << name;
    EXPECT_GE(flow.n_iterations(), 10u) << name << ": an approximate inverse cannot be that good";
    if (std::getenv("GEMMULE_PRINT_ITERATIONS") != nullptr &&
        Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::cout << name << ": " << flow.iterative.n_unknowns() << " unknowns, " << flow.n_iterations()
                << " iterations, difference " << difference << std::endl;
  }

  std::string name_of(const char *const mesh, const double ratio)
  {
    return std::string(mesh) + " at viscosity ratio " + std::to_string(ratio);
  }

  TEST(ParallelIterativeFlow, OnUniformMeshesItIsThatOfTheDirectSolver)
  {
    for (const double ratio : {0.01, 1., 100.})
    {
      BothSolvers<2> coarse(3, off_the_grid, ratio), fine(4, off_the_grid, ratio);
      expect_the_same_flow(coarse, 55, name_of("level 3", ratio));
      expect_the_same_flow(fine, 55, name_of("level 4", ratio));
    }
  }

  TEST(ParallelIterativeFlow, WithHangingNodesNearTheMembraneItIsThatOfTheDirectSolver)
  {
    for (const double ratio : {0.01, 1., 100.})
    {
      BothSolvers<2> flow(4, off_the_grid, ratio,
                          [](const Point<2> &p) { return std::abs(p.norm() - 0.45) < 0.13; });
      expect_the_same_flow(flow, 55, name_of("refined near the membrane", ratio));
    }
  }

  TEST(ParallelIterativeFlow, WithHangingNodesOnCutCellsItIsThatOfTheDirectSolver)
  {
    for (const double ratio : {0.01, 1., 100.})
    {
      // Two quadrants are finer, so that the membrane crosses faces with hanging nodes.
      BothSolvers<2> flow(4, off_the_grid, ratio, [](const Point<2> &p) { return p[0] * p[1] > 0.; });
      expect_the_same_flow(flow, 90, name_of("two fine quadrants", ratio));
    }
  }

  TEST(ParallelIterativeFlow, IterationsHardlyDependOnHowCellsAreCut)
  {
    const double h = 1. / 8.;
    std::vector<double> iterations;
    for (unsigned int position = 0; position < 20; ++position)
    {
      Point<2> center(std::fmod(0.1 + 0.618 * position, 1.) * h, std::fmod(0.2 + 0.414 * position, 1.) * h);
      if (position >= 16) // the circle reaches just over a line of the grid, or stays just before it
        center[0] = 0.5 - FlowOnCircle<2>::radius + (position % 2 == 0 ? 1e-6 : -1e-6) * h;
      BothSolvers<2> flow(4, center, 1.);
      flow.solve_iteratively();
      EXPECT_LT(flow.difference(), 1e-5) << "position " << position;
      iterations.push_back(flow.n_iterations());
    }
    const double mean = std::accumulate(iterations.begin(), iterations.end(), 0.) / iterations.size();
    for (unsigned int position = 0; position < iterations.size(); ++position)
      EXPECT_NEAR(iterations[position], mean, 0.15 * mean) << "position " << position;
  }

  TEST(ParallelIterativeFlow, MovingWallsAreFeltByBothSolversAlike)
  {
    class Shear : public Function<2>
    {
    public:
      Shear() : Function<2>(2) {}
      double value(const Point<2> &p, const unsigned int c) const override { return c == 0 ? p[1] : 0.; }
    };
    BothSolvers<2> flow(4, off_the_grid, 5.);
    flow.solve_iteratively(Shear());
    EXPECT_LT(flow.difference(Shear()), 1e-5);
    EXPECT_GT(flow.iterative.max_velocity(), 0.5);
  }

  TEST(ParallelIterativeFlow, ThreeDimensionsAreOneMore)
  {
    BothSolvers<3> flow(3, Point<3>(0.013, 0.007, -0.011), 1.);
    expect_the_same_flow(flow, 55, "h = 1/4 in 3D");
  }

  TEST(ParallelIterativeFlow, TheSolutionOfTheLastTimeIsAGuessThatNeedsNoIteration)
  {
    BothSolvers<2> flow(4, off_the_grid, 1.);
    flow.solve_iteratively();
    const LinearSystem &system = flow.iterative.linear_system();
    const LinearSystem::Vector &solution = flow.iterative.unknowns();
    std::vector<LinearSystem::Vector> right_sides(1, system.vmult(solution)), solutions(1, solution);
    for (auto *vector : {&right_sides[0], &solutions[0]})
      vector->zero_out_ghost_values();
    flow.linear_solver->solve(right_sides, solutions);
    EXPECT_EQ(flow.n_iterations(), 0u);
    solutions[0] -= solution;
    EXPECT_LT(solutions[0].linfty_norm(), 1e-10 * solution.linfty_norm());
  }

  TEST(ParallelIterativeFlow, TheNextFlowBeginsWithTheLastOneUnlessThatIsForgotten)
  {
    BothSolvers<2> flow(4, off_the_grid, 1.);
    flow.more_terms.push_back(std::make_shared<ArclengthConstraint<2>>(
        typename ArclengthConstraint<2>::Penalty{std::numeric_limits<double>::infinity(), 0., 1.}, 1.));
    const auto iterations = [&](const double shift)
    {
      flow.set_membrane(
          Functions::SignedDistance::Sphere<2>(off_the_grid + Point<2>(shift, 0.), FlowOnCircle<2>::radius));
      flow.set_tension([](const Point<2> &p) { return 1. + 0.5 * p[0] / p.norm(); });
      flow.solve_iteratively();
      EXPECT_EQ(flow.linear_solver->iterations().size(), 2u) << "one for the unit tension";
      return flow.linear_solver->iterations();
    };
    const auto first = iterations(0.);
    const double speed = flow.iterative.max_velocity();
    const auto repeated = iterations(0.), moved = iterations(1e-3);
    flow.iterative.forget_last_flow();
    const auto again = iterations(0.);
    EXPECT_EQ(again, first);
    EXPECT_EQ(flow.iterative.max_velocity(), speed) << "bit by bit";
    for (unsigned int k = 0; k < 2; ++k)
    {
      EXPECT_LE(repeated[k], 1u);
      EXPECT_LT(moved[k], first[k]);
    }
  }

  TEST(ParallelIterativeFlow, WithoutForcesThereIsNoFlow)
  {
    BothSolvers<2> flow(3, off_the_grid, 1.);
    flow.set_tension([](const Point<2> &) { return 0.; });
    flow.solve_iteratively();
    EXPECT_EQ(flow.iterative.max_velocity(), 0.);
    EXPECT_EQ(flow.n_iterations(), 0u);
  }

  TEST(ParallelIterativeFlow, WithSemiImplicitBendingItIsThatOfTheDirectSolver)
  {
    for (const double by_cell : {0.2, 20.})
    {
      BothSolvers<2> flow(5, off_the_grid, 1.);
      const double h = 1. / 16.;
      auto space = std::make_shared<TraceSpace<2>>(flow.mesh.triangulation);
      space->reinit_mesh();
      space->prepare(flow.interface, {{nullptr, nullptr}});
      std::vector<typename SemiImplicitBending<2>::NodalVelocity> at_rest(flow.geometry.cut_cells().size());
      flow.more_terms.push_back(
          std::make_shared<SemiImplicitBending<2>>(by_cell * h * h * h, space, at_rest, 1.));
      expect_the_same_flow(flow, 70, "bending of " + std::to_string(by_cell) + " h^3");
    }
  }

  TEST(ParallelIterativeFlow, AnExtraFieldThatSaysNothingIsPreconditionedByItsBlock)
  {
    BothSolvers<2> flow(5, off_the_grid, 1.);
    class WithoutPreconditioner : public SemiImplicitBending<2>
    {
    public:
      using SemiImplicitBending<2>::SemiImplicitBending;
      std::unique_ptr<ExtraFieldPreconditioner> extra_field_preconditioner(const FluidPair &) const override
      {
        return nullptr;
      }
    };
    auto space = std::make_shared<TraceSpace<2>>(flow.mesh.triangulation);
    space->reinit_mesh();
    space->prepare(flow.interface, {{nullptr, nullptr}});
    std::vector<typename SemiImplicitBending<2>::NodalVelocity> at_rest(flow.geometry.cut_cells().size());
    flow.more_terms.push_back(std::make_shared<WithoutPreconditioner>(1e-6, space, at_rest, 1.));
    expect_the_same_flow(flow, 70, "a weak extra field");
  }

  TEST(ParallelFlowSystemSolver, WhereIterationsFailTheFlowIsSolvedDirectly)
  {
    FlowOnCircle<2> flow(3, off_the_grid);
    Parameters::Flow parameters;
    parameters.solver = Parameters::FlowSolver::iterative;
    parameters.largest_number_of_iterations = 5;
    StokesSolver<2> other(flow.mesh.triangulation, flow.fluid, parameters);
    other.reinit_mesh();
    flow.set_tension([](const Point<2> &p) { return 1. + 0.5 * p[0]; });
    flow.solve(Functions::ZeroFunction<2>(2));
    const typename StokesSolver<2>::Terms terms{std::make_shared<TensionForce<2>>(flow.tension, 1.)};
    for (unsigned int step = 0; step < 2; ++step) // it tries again each time
    {
      other.forget_last_flow(); // from which it would converge
      other.prepare(flow.geometry, Functions::ZeroFunction<2>(2), terms);
      EXPECT_EQ(other.linear_solver_report().warning, "");
      other.solve();
      EXPECT_NEAR(other.max_velocity(), flow.solver.max_velocity(), 1e-12);
      const auto report = other.linear_solver_report();
      EXPECT_EQ(report.method, "MUMPS");
      EXPECT_EQ(report.iterations, 0u);
      EXPECT_NE(report.warning.find("does not converge: after 5 iterations"), std::string::npos)
          << report.warning;
      EXPECT_NE(report.warning.find("solved directly instead"), std::string::npos) << report.warning;
    }
  }

  TEST(FlowSystemSolver, AutomaticIsDirectInTwoDimensionsUnlessTheSystemIsLarge)
  {
    using Choice = Parameters::FlowSolver;
    EXPECT_FALSE(FlowSystemSolver::is_iterative(Choice::automatic, 2, 350000, 1));
    EXPECT_TRUE(FlowSystemSolver::is_iterative(Choice::automatic, 3, 13083, 1));
    EXPECT_TRUE(FlowSystemSolver::is_iterative(Choice::automatic, 3, 1000, 2));
    EXPECT_FALSE(FlowSystemSolver::is_iterative(Choice::automatic, 2, 250000, 2));
    EXPECT_TRUE(FlowSystemSolver::is_iterative(Choice::automatic, 2, 350000, 2));
    EXPECT_TRUE(FlowSystemSolver::is_iterative(Choice::automatic, 2, 500000, 1));
    for (const unsigned int dimension : {2, 3})
      for (const unsigned int n_unknowns : {100, 10000000})
      {
        EXPECT_TRUE(FlowSystemSolver::is_iterative(Choice::iterative, dimension, n_unknowns, 1));
        EXPECT_FALSE(FlowSystemSolver::is_iterative(Choice::direct, dimension, n_unknowns, 1));
      }
  }

  TEST(ParallelIterativeFlow, ItSaysOnAllRanksThatItDoesNotConverge)
  {
    BothSolvers<2> flow(3, off_the_grid, 1., {}, 1e-8, 5);
    try
    {
      flow.solve_iteratively();
      FAIL() << "Five iterations are not enough.";
    }
    catch (const SimulationError &error)
    {
      EXPECT_NE(std::string(error.what()).find("does not converge: after 5 iterations"), std::string::npos)
          << error.what();
    }
  }
} // namespace
} // namespace Gemmule::Testing
