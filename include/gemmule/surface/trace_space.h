// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/active_dofs.h>
#include <gemmule/algebra/linear_system.h>
#include <gemmule/mesh/cell_locator.h>
#include <gemmule/surface/surface_step.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <array>
#include <memory>
#include <vector>

namespace Gemmule
{
template <int dim>
class CutGeometry;
template <int dim>
struct CutCell;
template <int dim>
class Interface;

/** A locally owned cell of the active mesh. */
template <int dim>
struct TraceCell
{
  unsigned int active_cell_index;
  dealii::Point<dim> corner;
  double size;
  /** The cell's part of the membrane, or nullptr; and its place in CutGeometry::cut_cells(). */
  const CutCell<dim> *cut = nullptr;
  unsigned int cut_index = dealii::numbers::invalid_unsigned_int;

  /** int_cell (n.grad phi_i)(n.grad phi_j), n = grad(level set)/|grad(level set)|. */
  dealii::FullMatrix<double> normal_derivatives;

  struct CloudPoint
  {
    unsigned int index;      ///< in the cloud
    dealii::Point<dim> unit; ///< unit coordinates in this cell
  };
  /** The points of the two earlier membranes in this cell. */
  std::array<std::vector<CloudPoint>, 2> cloud_points;
};

/**
 * The trace finite element space of the surface fields: continuous Q2 on the cells of the active mesh, that
 * is those that the membrane cuts now, those that contain points of the earlier membranes, and those in
 * between (doc/method-surface.md; Olshanskii, Reusken, Grande, SINUM 47 (2009)).
 *
 * The values off the membrane are determined by the stabilisation (rho/h) int_active (n.grad f)(n.grad v)
 * alone, which extends a field constantly along normals as far as the earlier membranes are (Lehrenfeld,
 * Olshanskii, Xu, SINUM 56 (2018)); it vanishes for v = 1, so that it does not touch the balance of mass.
 */
template <int dim>
class TraceSpace
{
public:
  using Basis = TensorLagrange<dim, 2>;
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

  explicit TraceSpace(const dealii::Triangulation<dim> &triangulation);

  /** Call after every change of the mesh, and before anything else. Collective. */
  void reinit_mesh();

  /**
   * Finds the active mesh and numbers its unknowns.
   *
   * @param interface near to a signed distance in the active mesh; its cut cells are kept by reference until
   * the next call
   * @param clouds earlier membranes (nullptr: none), complete on every rank
   * Throws SimulationError if an earlier membrane reaches out of the mesh. Collective.
   */
  void prepare(const Interface<dim> &interface, const std::array<const MembraneCloud<dim> *, 2> &clouds);

  const CutGeometry<dim> &geometry() const { return *current_geometry; }
  const std::vector<TraceCell<dim>> &active_mesh() const { return cells; }

  /** The unknowns of each cell of the active mesh for one field (rows in lexicographic order). */
  const std::vector<CondensedIndices> &elements() const { return cell_elements; }

  /** Unknowns of one field, on all ranks. */
  unsigned int n_unknowns() const { return active_dofs.size(); }
  /** How those unknowns are distributed. */
  const UnknownPartition &partition() const { return active_dofs.partition(); }

  /**
   * Nodal values on the cut cells of one field of a solution, ghosted, of a system in which element k has the
   * unknowns of cell k of the active mesh, of one field after the other (begin_system()).
   */
  TraceField<dim> extract(const LinearSystem &system, const LinearSystem::Vector &solution,
                          unsigned int field = 0) const;

  MPI_Comm communicator() const { return dof_handler.get_communicator(); }

private:
  void locate_clouds(const Interface<dim> &interface, const std::array<const MembraneCloud<dim> *, 2> &clouds,
                     std::vector<bool> &is_in_active_mesh);
  void compute_normal_derivatives(TraceCell<dim> &cell,
                                  const std::array<double, TensorLagrange<dim, 3>::n> &level_set) const;

  const dealii::Triangulation<dim> &triangulation;
  dealii::FE_Q<dim> fe;
  dealii::DoFHandler<dim> dof_handler;
  dealii::AffineConstraints<double> constraints;
  std::vector<unsigned int> lexicographic;
  CellLocator<dim> locator;
  std::vector<typename dealii::DoFHandler<dim>::active_cell_iterator> owned_cells; ///< by active_cell_index

  const CutGeometry<dim> *current_geometry = nullptr;
  ActiveDofs<dim> active_dofs;
  std::vector<TraceCell<dim>> cells;
  std::vector<CondensedIndices> cell_elements;

  struct Located
  {
    unsigned int active_cell_index;
    unsigned int cloud;
    typename TraceCell<dim>::CloudPoint point;
  };
  std::vector<Located> located;
};
} // namespace Gemmule
