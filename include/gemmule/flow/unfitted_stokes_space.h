// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/active_dofs.h>
#include <gemmule/flow/boundary_velocity.h>
#include <gemmule/flow/interior_face.h>
#include <gemmule/flow/stokes_layout.h>
#include <gemmule/geometry/cut_geometry.h>

#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/lac/affine_constraints.h>

#include <array>
#include <vector>

namespace Gemmule
{
/**
 * Velocity-pressure pairs Q2-Q1 of both fluids on one mesh (doc/method-flow.md): one Taylor-Hood
 * DoFHandler, of whose dofs each fluid has its own copy, active on the cells that the fluid touches. Each
 * fluid is a field of two parts, velocity and pressure (FlowBlock).
 *
 * The equations determine the pressure up to a constant. corner_unknown() is an unknown that can be fixed at
 * zero instead: that of the pressure at the lower corner of the box.
 */
template <int dim>
class UnfittedStokesSpace
{
public:
  using Layout = StokesLayout<dim>;

  explicit UnfittedStokesSpace(const dealii::parallel::distributed::Triangulation<dim> &triangulation);

  /** Dofs, hanging nodes and tables of cells and faces: after every change of the mesh. Collective. */
  void reinit_mesh();

  /**
   * Numbers the unknowns for the given position of the membrane and velocity on the boundary (time set by the
   * caller). Throws SimulationError if the membrane touches the boundary of the box. Collective.
   */
  void reinit(const CutGeometry<dim> &geometry, const dealii::Function<dim> &boundary_velocity);

  const dealii::DoFHandler<dim> &dof_handler() const { return handler; }
  const dealii::parallel::distributed::Triangulation<dim> &mesh() const { return triangulation; }
  const dealii::AffineConstraints<double> &hanging_node_constraints() const { return hanging_nodes; }
  const ActiveDofs<dim> &active_dofs(unsigned int fluid) const { return active[fluid]; }

  /** Velocities and pressures of both fluids on all ranks, but for the constant of the pressure. */
  dealii::types::global_dof_index n_unknowns() const { return active[0].size() + active[1].size() - 1; }

  /** Adds the two fluids as the first fields of a system. */
  void add_fields(BlockNumbering &numbering) const;
  /** Lets active_dofs() have the numbers of that system, which is closed now. */
  void renumber(const BlockNumbering &numbering);
  /** The number of the pressure at the lower corner of the box after renumber(), on all ranks. Collective. */
  dealii::types::global_dof_index corner_unknown() const;

  /** Locally owned cells by active_cell_index, in the order of the mesh. */
  const std::vector<unsigned int> &owned_cells() const { return owned; }
  /** Faces in the charge of this rank: the owner of the finer cell; between equal cells the smaller subdomain
   * id. */
  const std::vector<InteriorFace> &interior_faces() const { return faces; }
  /** Edge length of an owned or ghost cell. */
  double cell_size(unsigned int active_cell_index) const { return sizes[active_cell_index]; }
  unsigned int cell_level(unsigned int active_cell_index) const { return levels[active_cell_index]; }
  /** Does an owned or ghost cell touch the boundary of the box? */
  bool at_boundary(unsigned int active_cell_index) const { return boundary[active_cell_index]; }
  /** Global dofs of an owned or ghost cell in the order of StokesLayout. */
  const std::vector<dealii::types::global_dof_index> &cell_dofs(unsigned int active_cell_index) const
  {
    return dofs[active_cell_index];
  }

  double removed_boundary_flux() const { return boundary_data.removed_flux(); }
  MPI_Comm communicator() const { return handler.get_communicator(); }

private:
  /** On all ranks the same constraint of a dof. Collective. */
  void constrain_hanging_nodes();
  void find_faces();
  void find_corner();

  const dealii::parallel::distributed::Triangulation<dim> &triangulation;
  dealii::FESystem<dim> element;
  dealii::DoFHandler<dim> handler;
  dealii::AffineConstraints<double> hanging_nodes;
  dealii::AffineConstraints<double> outside_constraints;
  std::array<ActiveDofs<dim>, 2> active;
  BoundaryVelocity<dim> boundary_data;
  dealii::types::global_dof_index corner_pressure = dealii::numbers::invalid_dof_index;

  std::vector<unsigned int> owned;
  std::vector<InteriorFace> faces;
  std::vector<double> sizes;
  std::vector<unsigned char> levels;
  std::vector<bool> boundary;
  std::vector<std::vector<dealii::types::global_dof_index>> dofs;
};
} // namespace Gemmule
