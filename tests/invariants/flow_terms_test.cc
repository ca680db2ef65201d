// SPDX-License-Identifier: LGPL-2.1-or-later
// What the seams of the flow promise: any linear solver, any number of terms with fields of their own.
#include <gemmule/algebra/block_view.h>
#include <gemmule/flow/flow_term.h>
#include <gemmule/surface/trace_forms.h>

#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>
#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/trilinos_vector.h>

#include <gtest/gtest.h>

#include "support/flow_on_circle.h"

namespace Gemmule::Testing
{
namespace
{
  double stretching_tension(const Point<2> &p)
  {
    return 1. + 0.5 * p[0] + 0.3 * p[0] * p[1];
  }

  /** Solves by the Schur complement of the pressure: of the matrix it only knows the blocks. */
  class SchurComplementSolver : public LinearSolver
  {
  public:
    void prepare(const SubassembledMatrix &matrix, const BlockNumbering &numbering,
                 const Index fixed) override
    {
      fixed_pressure = fixed == numbers::invalid_dof_index ? fixed : numbering.block_index(fixed).second;
      view = std::make_unique<BlockView>(matrix, numbering);
      velocity_solver = std::make_unique<TrilinosWrappers::SolverDirect>(control);
      velocity_solver->initialize(view->matrix().block(0, 0));
    }

    void solve(const std::vector<Vector> &right_sides, std::vector<Vector> &solutions) override
    {
      using BlockVector = TrilinosWrappers::MPI::Vector;
      struct SchurComplement
      {
        const TrilinosWrappers::BlockSparseMatrix &matrix;
        TrilinosWrappers::SolverDirect &velocity_solver;
        mutable BlockVector force, velocity;
        void vmult(BlockVector &result, const BlockVector &pressure) const
        {
          matrix.block(0, 1).vmult(force, pressure);
          velocity_solver.solve(velocity, force);
          matrix.block(1, 0).vmult(result, velocity);
          matrix.block(1, 1).vmult(velocity_of_pressure(pressure), pressure);
          result -= scratch;
          if (result.in_local_range(fixed_pressure))
            result(fixed_pressure) = pressure(fixed_pressure);
          result.compress(VectorOperation::insert);
        }
        types::global_dof_index fixed_pressure;
        mutable BlockVector scratch;
        BlockVector &velocity_of_pressure(const BlockVector &pressure) const
        {
          scratch.reinit(pressure);
          return scratch;
        }
      };
      for (unsigned int c = 0; c < right_sides.size(); ++c)
      {
        auto right_side = view->to_blocks(right_sides[c]);
        auto solution = view->make_vector();
        const auto &matrix = view->matrix();
        velocity_solver->solve(solution.block(0), right_side.block(0));
        BlockVector pressure_right_side(right_side.block(1));
        matrix.block(1, 0).vmult(pressure_right_side, solution.block(0));
        pressure_right_side -= right_side.block(1);
        if (pressure_right_side.in_local_range(fixed_pressure))
          pressure_right_side(fixed_pressure) = 0.;
        pressure_right_side.compress(VectorOperation::insert);
        SchurComplement schur{
            matrix, *velocity_solver, right_side.block(0), right_side.block(0), fixed_pressure, {}};
        SolverControl iterations(2000, 1e-13 * pressure_right_side.l2_norm());
        SolverGMRES<BlockVector> gmres(iterations, SolverGMRES<BlockVector>::AdditionalData(300));
        gmres.solve(schur, solution.block(1), pressure_right_side, PreconditionIdentity());
        BlockVector force(right_side.block(0));
        matrix.block(0, 1).vmult(force, solution.block(1));
        force.sadd(-1., 1., right_side.block(0));
        velocity_solver->solve(solution.block(0), force);
        view->from_blocks(solution, solutions[c]);
      }
    }

    Report report() const override { return {}; }

  private:
    SolverControl control;
    types::global_dof_index fixed_pressure = numbers::invalid_dof_index;
    std::unique_ptr<BlockView> view;
    std::unique_ptr<TrilinosWrappers::SolverDirect> velocity_solver;
  };

  /** A direct solver may be used for several right sides in turn; the largest difference of <u>. */
  template <int dim>
  double difference(const std::vector<MembraneVelocity<dim>> &a, const std::vector<MembraneVelocity<dim>> &b)
  {
    double largest = 0.;
    for (unsigned int k = 0; k < a.size(); ++k)
      for (unsigned int i = 0; i < a[k].nodal.size(); ++i)
        largest = std::max(largest, (a[k].nodal[i] - b[k].nodal[i]).norm());
    return Utilities::MPI::max(largest, MPI_COMM_WORLD);
  }

  /**
   * A viscous resistance of the membrane against dilatation by way of a field of its own:
   *
   *   sqrt(c) int y div_s <v>,   int y m + h int_active (n.grad y)(n.grad m) = sqrt(c) int m div_s <u>,
   *
   * so that y is sqrt(c) times the projection of div_s <u>.
   */
  class ProjectedDilatationalViscosity : public FlowTerm<2>
  {
  public:
    ProjectedDilatationalViscosity(const double viscosity, const TraceSpace<2> &space)
        : viscosity(viscosity), space(space)
    {
    }

    const TraceSpace<2> *extra_field_space() const override { return &space; }

    void add_matrix(const FlowTermContext<2> &context, Vector &right_side) const override
    {
      constexpr unsigned int nt = ExtraField<2>::n, first = ExtraField<2>::n_flow;
      FullMatrix<double> local(first + nt), mass(nt);
      for (unsigned int b = 0; b < space.active_mesh().size(); ++b)
      {
        const auto &trace_cell = space.active_mesh()[b];
        std::array<std::array<Tensor<1, 2>, nt>, InterfaceVelocity<2>::n_nodes> coupling{};
        SurfacePoint<2> point;
        for (unsigned int q = 0; q < trace_cell.cut->surface_points.size(); ++q)
        {
          point.reinit(*trace_cell.cut, q);
          const auto &gradients = context.interface_velocity.tangential_gradient(trace_cell.cut_index, q);
          for (unsigned int i = 0; i < gradients.size(); ++i)
            for (unsigned int j = 0; j < nt; ++j)
              coupling[i][j] +=
                  std::sqrt(viscosity) * trace_cell.cut->surface_weights[q] * point.values[j] * gradients[i];
        }
        local = 0.;
        context.interface_velocity.set_coupling(coupling, local);
        stabilised_mass_matrix(trace_cell, mass);
        for (unsigned int i = 0; i < nt; ++i)
          for (unsigned int j = 0; j < nt; ++j)
            local(first + i, first + j) = -mass(i, j);
        context.system.add_matrix(context.extra_field->element(b), local);
        context.system.add_inhomogeneity(context.extra_field->element(b), local, right_side);
      }
    }

    void read(const FlowTermContext<2> &context, const Vector &solution) override
    {
      field = context.extra_field->extract(context.system, solution);
    }

    TraceField<2> field; ///< y

  private:
    const double viscosity;
    const TraceSpace<2> &space;
  };

  struct FlowWithField : FlowOnCircle<2>
  {
    FlowWithField() : FlowOnCircle<2>(4, Point<2>(0.013, 0.007)), space(mesh.triangulation)
    {
      set_tension(stretching_tension);
      space.reinit_mesh();
      space.prepare(interface, {{nullptr, nullptr}});
    }
    TraceSpace<2> space;
  };

  TEST(ParallelFlowTerms, TheFlowThroughTheBlocksIsTheOneOfTheDirectSolver)
  {
    FlowOnCircle<2> flow(4, Point<2>(0.013, 0.007), 5.);
    flow.set_tension(stretching_tension);
    flow.solve(Functions::ZeroFunction<2>(2));

    StokesSolver<2> by_blocks(flow.mesh.triangulation, flow.fluid, Parameters::Flow(),
                              std::make_unique<SchurComplementSolver>());
    by_blocks.reinit_mesh();
    by_blocks.prepare(flow.geometry, Functions::ZeroFunction<2>(2),
                      {std::make_shared<TensionForce<2>>(flow.tension, flow.fluid.capillary_number)});
    by_blocks.solve();
    EXPECT_GT(flow.solver.max_velocity(), 1e-3);
    EXPECT_LT(difference(by_blocks.membrane_velocity(), flow.solver.membrane_velocity()),
              1e-9 * flow.solver.max_velocity());
    EXPECT_NEAR(by_blocks.viscous_dissipation(), flow.solver.viscous_dissipation(),
                1e-9 * flow.solver.viscous_dissipation());
  }

  TEST(ParallelFlowTerms, AMovedMembraneHasTheFlowThatANewSolverFinds)
  {
    FlowOnCircle<2> flow(4, Point<2>(0.013, 0.007));
    const auto move_to = [&](const double x)
    {
      flow.set_membrane(Functions::SignedDistance::Sphere<2>(Point<2>(x, 0.007), flow.radius));
      flow.set_tension(stretching_tension);
    };
    // Other cells are cut each time, on one rank or on all, and in between the same as before.
    for (const double x : {0.013, 0.04, 0.05, 0.051, 0.12, 0.013})
    {
      move_to(x);
      flow.solve(Functions::ZeroFunction<2>(2));
      StokesSolver<2> fresh(flow.mesh.triangulation, flow.fluid, Parameters::Flow());
      fresh.reinit_mesh();
      fresh.prepare(flow.geometry, Functions::ZeroFunction<2>(2),
                    {std::make_shared<TensionForce<2>>(flow.tension, flow.fluid.capillary_number)});
      fresh.solve();
      EXPECT_LT(difference(fresh.membrane_velocity(), flow.solver.membrane_velocity()), 1e-12) << x;
    }
  }

  TEST(ParallelFlowTerms, AnExtraFieldIsWhatItsEquationSays)
  {
    FlowWithField flow;
    const double viscosity = 2.;
    const auto term = std::make_shared<ProjectedDilatationalViscosity>(viscosity, flow.space);
    flow.solve(Functions::ZeroFunction<2>(2), {term});
    ASSERT_EQ(flow.solver.linear_system().numbering().n_blocks(), 3u);
    EXPECT_EQ(flow.solver.linear_system().numbering().size(first_extra_block), flow.space.n_unknowns());

    InterfaceVelocity<2> interface_velocity;
    interface_velocity.reinit(flow.geometry);
    const auto divergence = project<2>(flow.space,
                                       [&](const unsigned int k, const unsigned int q, const Point<2> &)
                                       {
                                         double sum = 0.;
                                         for (unsigned int i = 0; i < InterfaceVelocity<2>::n_nodes; ++i)
                                           sum += flow.solver.membrane_velocity()[k].nodal[i] *
                                                  interface_velocity.tangential_gradient(k, q)[i];
                                         return sum;
                                       });
    double largest = 0., error = 0.;
    for (unsigned int k = 0; k < divergence.size(); ++k)
      for (unsigned int i = 0; i < divergence[k].size(); ++i)
      {
        largest = std::max(largest, std::abs(divergence[k][i]));
        error = std::max(error, std::abs(term->field[k][i] - std::sqrt(viscosity) * divergence[k][i]));
      }
    EXPECT_GT(Utilities::MPI::max(largest, MPI_COMM_WORLD), 1e-2);
    EXPECT_LT(Utilities::MPI::max(error, MPI_COMM_WORLD), 1e-10);
  }

  TEST(ParallelFlowTerms, AnExtraFieldTakesItsPowerFromTheFlow)
  {
    FlowWithField flow;
    flow.solve(Functions::ZeroFunction<2>(2));
    const double free_dissipation = flow.solver.viscous_dissipation();
    flow.solve(Functions::ZeroFunction<2>(2),
               {std::make_shared<ProjectedDilatationalViscosity>(2., flow.space)});
    EXPECT_LT(flow.solver.viscous_dissipation(), 0.9 * free_dissipation);
  }

  TEST(ParallelFlowTerms, TwoExtraFieldsAtOnceAddUp)
  {
    FlowWithField flow;
    flow.solve(Functions::ZeroFunction<2>(2),
               {std::make_shared<ProjectedDilatationalViscosity>(2., flow.space)});
    const auto velocity = flow.solver.membrane_velocity();

    const auto first = std::make_shared<ProjectedDilatationalViscosity>(0.5, flow.space),
               second = std::make_shared<ProjectedDilatationalViscosity>(1.5, flow.space);
    flow.solve(Functions::ZeroFunction<2>(2), {first, second});
    ASSERT_EQ(flow.solver.linear_system().numbering().n_blocks(), 4u);
    EXPECT_LT(difference(velocity, flow.solver.membrane_velocity()), 1e-11);
    for (unsigned int k = 0; k < first->field.size(); ++k)
      for (unsigned int i = 0; i < first->field[k].size(); ++i)
        EXPECT_NEAR(std::sqrt(3.) * first->field[k][i], second->field[k][i], 1e-10);
  }
} // namespace
} // namespace Gemmule::Testing
