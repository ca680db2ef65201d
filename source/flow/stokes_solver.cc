// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/stokes_solver.h>
#include <gemmule/parameters/fluid.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace Gemmule
{
using namespace dealii;

template <int dim>
StokesSolver<dim>::StokesSolver(const parallel::distributed::Triangulation<dim> &triangulation,
                                const Parameters::Fluid &fluid, const Parameters::Flow &discretisation)
    : capillary_number(fluid.capillary_number), space(triangulation), assembler(space, fluid, discretisation),
      system(triangulation.get_communicator(), true)
{
}

template <int dim>
void StokesSolver<dim>::reinit_mesh()
{
  space.reinit_mesh();
}

template <int dim>
void StokesSolver<dim>::prepare(const CutGeometry<dim> &new_geometry, const Function<dim> &boundary_velocity,
                                const SemiImplicitTension<dim> *new_semi_implicit,
                                SemiImplicitBending<dim> *new_semi_implicit_bending)
{
  geometry = &new_geometry;
  semi_implicit = new_semi_implicit;
  semi_implicit_bending = new_semi_implicit_bending;
  space.reinit(*geometry, boundary_velocity);
  assembler.add_elements(*geometry, system,
                         semi_implicit_bending != nullptr ? semi_implicit_bending->n_unknowns() : 0);
  if (semi_implicit_bending != nullptr)
    new_semi_implicit_bending->add_elements(space.n_unknowns(), assembler.cut_cell_elements(), system);
  system.finish_elements();
  assembler.assemble(*geometry, system);
  force.reinit(*geometry);
  rhs = assembler.boundary_rhs();
  if (semi_implicit != nullptr)
    semi_implicit->add_matrix(*geometry, force, capillary_number, assembler.fluids(),
                              assembler.cut_cell_elements(), system, rhs);
  if (semi_implicit_bending != nullptr)
    semi_implicit_bending->add_matrix(*geometry, force, capillary_number, assembler.fluids(), system, rhs);
  system.factorise();
}

template <int dim>
void StokesSolver<dim>::solve(const MembranePointValues &tension, const ArclengthPenalty *penalty,
                              const BendingForce<dim> *bending)
{
  Assert(geometry != nullptr, ExcMessage("prepare() must be called before solve()."));
  AssertDimension(tension.size(), geometry->cut_cells().size());
  const MPI_Comm communicator = space.communicator();
  const auto &fluids = assembler.fluids();
  const auto &elements = assembler.cut_cell_elements();
  const bool constrained = penalty != nullptr && penalty->stiffness > 0.;

  std::vector<std::vector<double>> solutions{rhs};
  force.add_rhs(&tension, 0., capillary_number, fluids, elements, system, solutions[0]);
  if (semi_implicit != nullptr)
    semi_implicit->add_rhs(*geometry, force, capillary_number, fluids, elements, system, solutions[0]);
  if (bending != nullptr)
    bending->add_rhs(force, capillary_number, fluids, elements, system, solutions[0]);
  if (semi_implicit_bending != nullptr)
    semi_implicit_bending->add_rhs(*geometry, capillary_number, system, solutions[0]);
  std::vector<double> unit_force;
  if (constrained)
  {
    unit_force.assign(system.n_unknowns(), 0.);
    force.add_rhs(nullptr, 1., capillary_number, fluids, elements, system, unit_force);
    solutions.push_back(unit_force);
  }
  system.solve(solutions);

  penalty_tension = 0.;
  std::vector<double> &unknowns = solutions[0];
  if (constrained)
  {
    // u = y + s z, y the flow without penalty, z the flow of a unit tension. Solving s = Lambda (L - L0 + dt
    // l(y + s z)) for s first is free of cancellation for any Lambda; -l(z) is the work of the unit tension,
    // hence not negative.
    const std::vector<double> &unit_flow = solutions[1];
    const double rate_without = Utilities::MPI::sum(
        force.integrate_divergence(nullptr, 1., force.average(fluids, elements, system, unknowns)),
        communicator);
    const double rate_of_unit =
        -capillary_number *
        Utilities::MPI::sum(std::inner_product(unit_force.begin(), unit_force.end(), unit_flow.begin(), 0.),
                            communicator);
    const double lambda = penalty->stiffness, dt = penalty->time_step;
    if (std::isinf(lambda))
      // On a circle no tension changes the length: the flow of a unit tension is round-off there, as is what
      // it would have to balance.
      penalty_tension = (penalty->excess / dt + rate_without) /
                        std::max(-rate_of_unit, 1e-9 * geometry->measure() / capillary_number);
    else
      penalty_tension = lambda * (penalty->excess + dt * rate_without) / (1. - lambda * dt * rate_of_unit);
    unit_tension_velocity = force.average(fluids, elements, system, unit_flow, /*homogeneous =*/true);
    for (std::size_t i = 0; i < unknowns.size(); ++i)
      unknowns[i] += penalty_tension * unit_flow[i];
  }

  velocity = force.average(fluids, elements, system, unknowns);
  rate = Utilities::MPI::sum(force.integrate_divergence(nullptr, 1., velocity), communicator);
  work = -Utilities::MPI::sum(force.integrate_divergence(&tension, penalty_tension, velocity), communicator);
  if (bending != nullptr)
    work -= Utilities::MPI::sum(bending->power(force, velocity), communicator);
  flux = Utilities::MPI::sum(force.integrate_flux(velocity), communicator);
  bulk.reinit(space, *geometry, assembler, system, unknowns);
}

template class StokesSolver<2>;
template class StokesSolver<3>;
} // namespace Gemmule
