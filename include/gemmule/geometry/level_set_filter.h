// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/tensor_lagrange.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <array>
#include <vector>

namespace Gemmule
{
/**
 * Sets what a continuous Q3 level set has beside Q2 in the cells that the membrane cuts, of which no force is
 * aware.
 *
 * Traces of velocity and curvature are Q2. Of the cubic bubble b of a cell in one direction, which vanishes
 * at both faces and in the middle, they see nothing, since the integral of b' v' is zero for all v in Q2:
 * neither tension nor bending damps it, negative tension makes it grow, and pointwise curvature has its
 * second derivative. But a bubble that does not belong to a smooth function jumps at the faces. One sweep
 * subtracts, for all faces of cut cells and all nodes of Gauss-Lobatto on them at once,
 *
 *     phi <- phi - omega sum_j sum_b b (a_j . b) (a_j . phi) / sum_b (a_j . b)^2,     a_j . phi = h^j [d^j
 * phi / dn^j],
 *
 * j = 1, 2, with the bubbles b of the two cells on the line through the node. On equal cells the operator is
 * 2 omega times the identity on the bubbles of a line, so that a few sweeps fit them to what the neighbours
 * have in Q2, to order h^5, and more of them change nothing. What the forces see stays as it is. Jumps of
 * more than 0.5 (of the slope, or of h times the curvature) are those of a distance at its medial axis or of
 * a membrane with corners, and are left alone (doc/method.md, "The level set").
 */
template <int dim>
class LevelSetFilter
{
public:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

  /**
   * @param dofs of FE_Q(3) on a mesh of cubes; must outlive the object, as must @p node_to_dof
   * @param node_to_dof lexicographic node -> dof of the cell
   */
  LevelSetFilter(const dealii::DoFHandler<dim> &dofs, const std::vector<unsigned int> &node_to_dof);

  /**
   * One sweep.
   * @param phi with up-to-date ghost values; afterwards they are zero, and the hanging nodes are not yet
   * constrained
   * @param candidates the cells that the membrane may cut, by active_cell_index
   */
  void sweep(Vector &phi, const std::vector<bool> &candidates) const;

private:
  using Basis = TensorLagrange<dim, 3>;
  using CellIterator = typename dealii::DoFHandler<dim>::active_cell_iterator;

  /** A node of one of the two cells at a face, with a factor. */
  struct Entry
  {
    bool is_of_neighbor;
    unsigned int node; ///< lexicographic
    double factor;
  };
  /** The jump of a derivative in a point of a face, and the change of phi that a unit of it asks for. */
  struct Jump
  {
    std::vector<Entry> functional;
    std::vector<Entry> correction;
  };
  /** Position of a face: of which cell, and where on that of the neighbor, which may be twice as large. */
  struct FacePosition
  {
    unsigned int face;
    dealii::Point<dim> corner_in_neighbor; ///< of the cell, in unit coordinates of the neighbor
    double size_ratio;                     ///< cell to neighbor: 1 or 1/2
  };

  struct CellValues
  {
    std::array<dealii::types::global_dof_index, Basis::n> dofs;
    std::array<double, Basis::n> phi;
  };

  static std::vector<Jump> make_jumps(const FacePosition &position);
  /** Index into @p jumps of the face between a cell and its neighbor, which is not smaller. */
  static unsigned int position_index(const CellIterator &cell, unsigned int face,
                                     const CellIterator &neighbor);
  CellValues read(const CellIterator &cell, const Vector &phi) const;
  /** By active_cell_index; known for owned and ghost cells. */
  std::vector<bool> find_cut_cells(const Vector &phi, const std::vector<bool> &candidates) const;

  const dealii::DoFHandler<dim> &dof_handler;
  const std::vector<unsigned int> &node_to_dof;
  std::vector<std::vector<Jump>> jumps; ///< for every position of a face
};
} // namespace Gemmule
