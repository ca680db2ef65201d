// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/flow/flow_system_solver.h>
#include <gemmule/flow/stokes_solver.h>
#include <gemmule/parameters/discretisation.h>
#include <gemmule/parameters/fluid.h>

#include <deal.II/base/mpi.h>

namespace Gemmule
{
using namespace dealii;

template <int dim>
StokesSolver<dim>::StokesSolver(const parallel::distributed::Triangulation<dim> &triangulation,
                                const Parameters::Fluid &fluid, const Parameters::Flow &discretisation,
                                std::unique_ptr<LinearSolver> linear_solver)
    : capillary_number(fluid.capillary_number), space(triangulation), assembler(space, fluid, discretisation),
      system(triangulation.get_communicator(), true, connect(std::move(linear_solver), discretisation))
{
}

template <int dim>
std::unique_ptr<LinearSolver> StokesSolver<dim>::connect(std::unique_ptr<LinearSolver> linear_solver,
                                                         const Parameters::Flow &discretisation)
{
  if (linear_solver == nullptr)
    linear_solver = std::make_unique<FlowSystemSolver>(space.communicator(), dim, discretisation);
  if (auto *const flow_solver = dynamic_cast<FlowLinearSolver *>(linear_solver.get()))
    flow_solver->set_structure_source([this] { return find_structure(); });
  return linear_solver;
}

template <int dim>
std::unique_ptr<const FlowStructure> StokesSolver<dim>::find_structure() const
{
  auto structure = find_flow_structure(space, *geometry, assembler.fluids(), system);
  for (const auto &term : terms)
    if (term->extra_field_space() != nullptr)
      structure->extra_fields.push_back(term->extra_field_preconditioner(assembler.fluids()));
  return structure;
}

template <int dim>
void StokesSolver<dim>::reinit_mesh()
{
  space.reinit_mesh();
  geometry = nullptr;
  guess.forget();
}

template <int dim>
FlowTermContext<dim> StokesSolver<dim>::context(const unsigned int term)
{
  return {interface_velocity, system, extra_fields[term].get()};
}

template <int dim>
void StokesSolver<dim>::set_up_system()
{
  BlockNumbering numbering(space.communicator());
  space.add_fields(numbering);
  extra_fields.clear();
  unsigned int block = first_extra_block;
  for (const auto &term : terms)
  {
    extra_fields.emplace_back();
    if (const TraceSpace<dim> *const trace_space = term->extra_field_space())
      extra_fields.back() = std::make_unique<ExtraField<dim>>(
          *trace_space, numbering.add_field(trace_space->partition(), {block++}));
  }
  numbering.close();
  space.renumber(numbering);

  system.begin(numbering);
  assembler.add_elements(*geometry, system);
  for (const auto &field : extra_fields)
    if (field != nullptr)
      field->add_elements(assembler.cut_cell_indices(), system);
  system.finish_elements();
}

template <int dim>
void StokesSolver<dim>::prepare(const CutGeometry<dim> &new_geometry, const Function<dim> &boundary_velocity,
                                const Terms &new_terms)
{
  geometry = &new_geometry;
  terms = new_terms;
  space.reinit(*geometry, boundary_velocity);
  set_up_system();
  system.reinit(wall_right_side);
  assembler.assemble(*geometry, system, wall_right_side);
  interface_velocity.reinit(*geometry);
  interface_velocity.connect(assembler.fluids(), assembler.cut_cell_elements());
  for (unsigned int t = 0; t < terms.size(); ++t)
    terms[t]->add_matrix(context(t), wall_right_side);
  wall_right_side.compress(VectorOperation::add);
  system.factorise(space.corner_unknown());
}

template <int dim>
void StokesSolver<dim>::solve()
{
  Assert(geometry != nullptr, ExcMessage("prepare() must be called before solve()."));
  unsigned int with_unit_force = terms.size();
  for (unsigned int t = 0; t < terms.size(); ++t)
    if (terms[t]->has_unit_force())
    {
      Assert(with_unit_force == terms.size(), ExcMessage("At most one term may have a unit force."));
      with_unit_force = t;
    }
  std::vector<LinearSystem::Vector> right_sides(with_unit_force < terms.size() ? 2 : 1, system.make_vector());
  right_sides[0] = wall_right_side;
  for (unsigned int t = 0; t < terms.size(); ++t)
    terms[t]->add_right_side(context(t), right_sides[0]);
  if (with_unit_force < terms.size())
    terms[with_unit_force]->add_unit_force(context(with_unit_force), right_sides[1]);
  std::vector<LinearSystem::Vector> solutions(right_sides.size(), system.make_vector());
  guess.recall(space, solutions);
  system.solve(right_sides, solutions);
  guess.remember(space, solutions);
  solution.swap(solutions[0]); // a copy would not have the ghosts
  if (with_unit_force < terms.size())
    add_unit_force_flow(with_unit_force, right_sides[1], solutions[1]);

  const MPI_Comm communicator = space.communicator();
  velocity = interface_velocity.gather(system, solution);
  rate = Utilities::MPI::sum(interface_velocity.integrate_divergence(nullptr, velocity), communicator);
  flux = Utilities::MPI::sum(interface_velocity.integrate_flux(velocity), communicator);
  double power = 0.;
  for (unsigned int t = 0; t < terms.size(); ++t)
  {
    terms[t]->read(context(t), solution);
    power += terms[t]->power(interface_velocity, velocity);
  }
  work = -Utilities::MPI::sum(power, communicator);
  bulk.reinit(space, *geometry, assembler, system, solution);
}

template <int dim>
void StokesSolver<dim>::add_unit_force_flow(const unsigned int t, const LinearSystem::Vector &unit_force,
                                            const LinearSystem::Vector &unit_flow)
{
  const auto without = interface_velocity.gather(system, solution);
  const auto by_unit_force = interface_velocity.gather(system, unit_flow, /*homogeneous =*/true);
  const double amplitude =
      terms[t]->find_amplitude(context(t), {without, by_unit_force, unit_force * unit_flow});
  solution.zero_out_ghost_values();
  solution.add(amplitude, unit_flow);
  solution.update_ghost_values();
}

template class StokesSolver<2>;
template class StokesSolver<3>;
} // namespace Gemmule
