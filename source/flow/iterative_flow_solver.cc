// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/algebra/chebyshev.h>
#include <gemmule/algebra/matrix_part.h>
#include <gemmule/algebra/two_level_cycle.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/flow/iterative_flow_solver.h>

#include <deal.II/base/mpi.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/solver_gmres.h>
#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/trilinos_vector.h>

#include <algorithm>
#include <numeric>
#include <sstream>

namespace Gemmule
{
using namespace dealii;

namespace
{
  Epetra_Vector epetra_view(const Epetra_BlockMap &map, const double *const values)
  {
    return Epetra_Vector(View, map, const_cast<double *>(values));
  }
} // namespace

/** The part of a vector that is this rank's range of one block: as local entries [begin, end). */
struct IterativeFlowSolver::LocalRange
{
  LocalRange(const BlockNumbering &numbering, const unsigned int block)
  {
    const IndexSet all = numbering.locally_owned(), own = numbering.locally_owned(block);
    size = own.n_elements();
    begin = size == 0 ? 0 : all.index_within_set(own.nth_index_in_set(0));
  }
  unsigned int begin, size;
};

/**
 * The equations of the pressure sum up to zero, and constants of the pressure have no effect, but for errors
 * of quadrature. The fixed unknown takes up both: its value is zero, and its equation is what makes the sum
 * of all of them zero. To leave that unknown out instead would cost a third of the iterations.
 */
class IterativeFlowSolver::ConstantProjection
{
public:
  ConstantProjection(const BlockNumbering &numbering, const Index fixed)
      : pressure(numbering, pressure_block), communicator(numbering.communicator())
  {
    const IndexSet owned = numbering.locally_owned();
    if (owned.is_element(fixed))
      fixed_here = owned.index_within_set(fixed);
  }

  /** Makes the equations of the pressure compatible. */
  void remove_from_residual(Vector &residual) const
  {
    double sum = 0.;
    for (unsigned int i = pressure.begin; i < pressure.begin + pressure.size; ++i)
      sum += residual.local_element(i);
    sum = Utilities::MPI::sum(sum, communicator);
    if (fixed_here != numbers::invalid_unsigned_int)
      residual.local_element(fixed_here) -= sum;
  }

  /** Makes the fixed pressure zero. */
  void remove_from_solution(Vector &solution) const
  {
    const double here = fixed_here == numbers::invalid_unsigned_int ? 0. : solution.local_element(fixed_here);
    const double value = Utilities::MPI::sum(here, communicator);
    for (unsigned int i = pressure.begin; i < pressure.begin + pressure.size; ++i)
      solution.local_element(i) -= value;
  }

private:
  const LocalRange pressure;
  const MPI_Comm communicator;
  unsigned int fixed_here = numbers::invalid_unsigned_int; ///< the fixed unknown on its owner
};

/** The matrix, with compatible equations of the pressure. */
class IterativeFlowSolver::Operator
{
public:
  Operator(const SubassembledMatrix &matrix, const ConstantProjection &constant)
      : matrix(matrix), constant(constant)
  {
  }

  void vmult(Vector &product, const Vector &x) const
  {
    product = 0.;
    x.update_ghost_values();
    matrix.vmult_add(product.get_values(), x.get_values());
    x.zero_out_ghost_values();
    product.compress(VectorOperation::add);
    constant.remove_from_residual(product);
  }

private:
  const SubassembledMatrix &matrix;
  const ConstantProjection &constant;
};

class IterativeFlowSolver::Preconditioner
{
public:
  Preconditioner(const FlowStructure &structure, const SubassembledMatrix &matrix,
                 const BlockNumbering &numbering, const ConstantProjection &constant)
      : structure(structure), constant(constant), pressure(numbering, pressure_block)
  {
    const IndexSet owned = numbering.locally_owned();
    for (const auto unknown : structure.node_unknowns)
      node_entries.push_back(owned.index_within_set(unknown));
    make_velocity_cycle(matrix, numbering);
    make_schur_complement(matrix, numbering);
    make_coupling(matrix, numbering);
    for (unsigned int block = first_extra_block; block < numbering.n_blocks(); ++block)
    {
      extra_ranges.emplace_back(numbering, block);
      const auto *const special = structure.extra_fields.at(block - first_extra_block).get();
      if (special == nullptr)
        own_fields.push_back(std::make_unique<BlockFactors>(matrix, numbering, block));
      extra_fields.push_back(special != nullptr ? special : own_fields.back().get());
    }
  }

  /** Of the velocity: quadratic and linear elements, and what ML makes of the latter. */
  unsigned int n_levels() const { return 1 + velocity->n_coarse_levels(); }
  /** Of matrices on this rank, in bytes. */
  double memory_consumption() const
  {
    return scalar_matrix.memory_consumption() + schur_matrix.memory_consumption() +
           coupling.memory_consumption() + velocity->memory_consumption();
  }

  void vmult(Vector &z, const Vector &r) const
  {
    z = 0.;
    solve_pressure(z, r);
    constant.remove_from_solution(z);
    for (unsigned int f = 0; f < extra_fields.size(); ++f)
      extra_fields[f]->apply(r.begin() + extra_ranges[f].begin, z.begin() + extra_ranges[f].begin);
    solve_velocity(z, r);
  }

private:
  /** An extra field by the factors of its block. */
  class BlockFactors : public ExtraFieldPreconditioner
  {
  public:
    BlockFactors(const SubassembledMatrix &matrix, const BlockNumbering &numbering, const unsigned int block)
        : solver(control)
    {
      extract_part({{&matrix, 1.}}, part_of_block(matrix, numbering, block), numbering.communicator(),
                   block_matrix);
      solver.initialize(block_matrix);
      right_side.reinit(numbering.locally_owned_in_block(block), numbering.communicator());
      values.reinit(right_side);
    }

    void apply(const double *const residual, double *const solution) const override
    {
      std::copy_n(residual, right_side.locally_owned_size(), right_side.begin());
      solver.solve(values, right_side);
      std::copy_n(values.begin(), values.locally_owned_size(), solution);
    }

  private:
    TrilinosWrappers::SparseMatrix block_matrix;
    SolverControl control;
    mutable TrilinosWrappers::SolverDirect solver;
    mutable TrilinosWrappers::MPI::Vector right_side, values;
  };

  /** The places of the unknowns of one block in its own numbering. */
  static MatrixPart part_of_block(const SubassembledMatrix &matrix, const BlockNumbering &numbering,
                                  const unsigned int block)
  {
    MatrixPart part;
    part.rows.resize(matrix.n_rows());
    for (unsigned int row = 0; row < matrix.n_rows(); ++row)
      if (const auto place = numbering.block_index(matrix.partitioner()->local_to_global(row));
          place.first == block)
        part.rows[row] = {0, place.second};
    part.owned_rows = numbering.locally_owned_in_block(block);
    return part;
  }

  void make_velocity_cycle(const SubassembledMatrix &matrix, const BlockNumbering &numbering)
  {
    // Of the unknowns of other ranks their owners know component and node.
    const unsigned int n = structure.n_components;
    Vector code(matrix.partitioner());
    code = -1.;
    for (unsigned int k = 0; k < node_entries.size(); ++k)
      code.local_element(node_entries[k]) =
          static_cast<double>(structure.owned_nodes.nth_index_in_set(k / n)) * n + k % n;
    code.update_ghost_values();
    MatrixPart part;
    part.rows.resize(matrix.n_rows());
    for (unsigned int row = 0; row < matrix.n_rows(); ++row)
      if (code.local_element(row) >= 0.)
      {
        const auto value = static_cast<FlowStructure::Index>(code.local_element(row));
        part.rows[row] = {static_cast<unsigned int>(value % n), value / n};
      }
    part.owned_rows = structure.owned_nodes;
    extract_part({{&matrix, 1. / n}}, part, numbering.communicator(), scalar_matrix);
    velocity = std::make_unique<TwoLevelCycle>(scalar_matrix, structure.prolongation);
  }

  void make_schur_complement(const SubassembledMatrix &matrix, const BlockNumbering &numbering)
  {
    extract_part({{&matrix, -1.}, {&structure.pressure_mass, 1.}},
                 part_of_block(matrix, numbering, pressure_block), numbering.communicator(), schur_matrix);
    schur_complement = std::make_unique<Chebyshev>(schur_matrix.trilinos_matrix(), 8, 20.);
  }

  void make_coupling(const SubassembledMatrix &matrix, const BlockNumbering &numbering)
  {
    MatrixPart part;
    part.rows.resize(matrix.n_rows());
    part.columns.resize(matrix.n_rows());
    for (unsigned int row = 0; row < matrix.n_rows(); ++row)
    {
      const auto number = matrix.partitioner()->local_to_global(row);
      const bool is_velocity = numbering.block_index(number).first == velocity_block;
      (is_velocity ? part.rows : part.columns)[row] = {0, number};
    }
    part.owned_rows = part.owned_columns = numbering.locally_owned();
    extract_part({{&matrix, 1.}}, part, numbering.communicator(), coupling);
  }

  void solve_pressure(Vector &z, const Vector &r) const
  {
    const auto &map = schur_matrix.trilinos_matrix().RowMap();
    Epetra_Vector residual(Copy, map, const_cast<double *>(r.begin()) + pressure.begin), x(map);
    schur_complement->smooth(residual, x, /*update_residual =*/false);
    for (unsigned int i = 0; i < pressure.size; ++i)
      z.local_element(pressure.begin + i) = -x[i];
  }

  /** With the other fields in @p z already. */
  void solve_velocity(Vector &z, const Vector &r) const
  {
    const Epetra_CrsMatrix &couple = coupling.trilinos_matrix();
    const Epetra_Vector others = epetra_view(couple.DomainMap(), z.begin());
    Epetra_Vector forces(couple.RangeMap());
    couple.Multiply(false, others, forces);

    const unsigned int n = structure.n_components, n_nodes = structure.owned_nodes.n_elements();
    const auto &map = scalar_matrix.trilinos_matrix().RowMap();
    Epetra_MultiVector residual(map, n), x(map, n);
    for (unsigned int i = 0; i < n_nodes; ++i)
      for (unsigned int c = 0; c < n; ++c)
      {
        const unsigned int entry = node_entries[i * n + c];
        residual[c][i] = r.local_element(entry) - forces[entry];
      }
    velocity->apply(residual, x);
    for (unsigned int i = 0; i < n_nodes; ++i)
      for (unsigned int c = 0; c < n; ++c)
        z.local_element(node_entries[i * n + c]) = x[c][i];
  }

  const FlowStructure &structure;
  const ConstantProjection &constant;
  const LocalRange pressure;
  std::vector<unsigned int> node_entries; ///< FlowStructure::node_unknowns as entries of a vector
  TrilinosWrappers::SparseMatrix scalar_matrix, schur_matrix, coupling;
  std::unique_ptr<TwoLevelCycle> velocity;
  std::unique_ptr<Chebyshev> schur_complement;
  std::vector<LocalRange> extra_ranges;
  std::vector<const ExtraFieldPreconditioner *> extra_fields;
  std::vector<std::unique_ptr<BlockFactors>> own_fields; ///< of those that the structure says nothing of
};

IterativeFlowSolver::IterativeFlowSolver(const double tolerance,
                                         const unsigned int largest_number_of_iterations)
    : tolerance(tolerance), largest_number_of_iterations(largest_number_of_iterations)
{
}

IterativeFlowSolver::~IterativeFlowSolver() = default;

void IterativeFlowSolver::prepare(const SubassembledMatrix &new_matrix, const BlockNumbering &numbering,
                                  const Index fixed)
{
  AssertThrow(find_structure, ExcMessage("set_structure_source() must be called before prepare()."));
  preconditioner.reset();
  matrix = &new_matrix;
  structure = find_structure();
  constant = std::make_unique<ConstantProjection>(numbering, fixed);
  preconditioner = std::make_unique<Preconditioner>(*structure, *matrix, numbering, *constant);
}

LinearSolver::Report IterativeFlowSolver::report() const
{
  Report report;
  report.method = "FGMRES with multigrid of " + std::to_string(preconditioner->n_levels()) + " levels";
  report.memory = preconditioner->memory_consumption() + basis_memory;
  report.iterations = std::accumulate(counts.begin(), counts.end(), 0u);
  return report;
}

void IterativeFlowSolver::solve(const std::vector<Vector> &right_sides, std::vector<Vector> &solutions)
{
  const Operator equations(*matrix, *constant);
  counts.assign(right_sides.size(), 0);
  basis_memory = 0.;
  for (unsigned int c = 0; c < right_sides.size(); ++c)
  {
    Vector right_side = right_sides[c];
    constant->remove_from_residual(right_side);
    constant->remove_from_solution(solutions[c]);
    const double norm = right_side.l2_norm();
    SolverControl control(largest_number_of_iterations, tolerance * norm);
    const unsigned int basis_size = std::min(largest_number_of_iterations + 1, 100u);
    SolverFGMRES<Vector> fgmres(control, SolverFGMRES<Vector>::AdditionalData(basis_size));
    try
    {
      fgmres.solve(equations, solutions[c], right_side, *preconditioner);
    }
    catch (const SolverControl::NoConvergence &)
    {
      std::ostringstream message;
      message << "The iterative solver of the flow does not converge: after " << control.last_step()
              << " iterations the residual is " << control.last_value() / norm
              << " of the right side, and it should be " << tolerance
              << ". The mesh may not resolve the membrane: refine it with a higher 'Mesh/Membrane level'.";
      throw NoConvergence(message.str());
    }
    counts[c] = control.last_step();
    // Two vectors for each iteration: the basis, and what the preconditioner makes of it.
    basis_memory = std::max(basis_memory, 2. * std::min(counts[c] + 1, basis_size) * sizeof(double) *
                                              solutions[c].locally_owned_size());
  }
}
} // namespace Gemmule
