// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/linear_system.h>
#include <gemmule/flow/cut_cell_matrix.h>
#include <gemmule/flow/stokes_reference_matrices.h>
#include <gemmule/flow/unfitted_stokes_space.h>

#include <array>
#include <map>
#include <vector>

namespace Gemmule
{
namespace Parameters
{
  struct Fluid;
  struct Flow;
} // namespace Parameters

/** The element of a locally owned cell in the system. */
struct StokesCellElement
{
  unsigned int cell;     ///< active_cell_index
  unsigned int element;  ///< in the LinearSystem
  CellLocation location; ///< cut: the element holds both fluids, inside first
};

/**
 * Puts the doubled Taylor-Hood discretisation of doc/method-flow.md into a symmetric LinearSystem: one
 * element per uncut cell, one with both fluids per cut cell, and for each fluid and ghost-penalty face one
 * element per velocity component and one for the pressure (which do not couple).
 */
template <int dim>
class StokesAssembler
{
public:
  using Layout = StokesLayout<dim>;

  StokesAssembler(const UnfittedStokesSpace<dim> &space, const Parameters::Fluid &fluid,
                  const Parameters::Flow &discretisation);

  /**
   * Adds the elements for the position of the membrane for which the space was numbered to a system that has
   * been begun. More elements, and then LinearSystem::finish_elements(), may follow before assemble().
   */
  void add_elements(const CutGeometry<dim> &geometry, LinearSystem &system);

  /**
   * Sets the matrix to that of the flow.
   * @param right_side of the system: gets what velocities at the walls contribute, this rank's part
   */
  void assemble(const CutGeometry<dim> &geometry, LinearSystem &system, LinearSystem::Vector &right_side);

  /** Elements of all locally owned cells in the order of the mesh. */
  const std::vector<StokesCellElement> &cell_elements() const { return cells; }
  /** Elements of the cut cells, in the order of CutGeometry::cut_cells(). */
  const std::vector<unsigned int> &cut_cell_elements() const { return cut_elements; }
  /** Their condensed indices. */
  const std::vector<CondensedIndices> &cut_cell_indices() const { return cut_indices; }

  const FluidPair &fluids() const { return pair; }

private:
  struct FaceElement
  {
    const InteriorFace *face;
    unsigned int fluid;
    unsigned int first_element; ///< dim velocity components, then the pressure
  };

  void add_cell_elements(const CutGeometry<dim> &geometry, LinearSystem &system);
  void add_face_elements(const CutGeometry<dim> &geometry, LinearSystem &system);
  void add_cell_matrix(const StokesCellElement &cell, const CutGeometry<dim> &geometry, LinearSystem &system,
                       LinearSystem::Vector &rhs);
  void add_face_matrices(const FaceElement &face, LinearSystem &system, LinearSystem::Vector &rhs);
  const dealii::FullMatrix<double> &uncut_cell_matrix(unsigned int cell, unsigned int fluid);

  const UnfittedStokesSpace<dim> &space;
  FluidPair pair;
  StokesReferenceMatrices<dim> reference;
  CutCellMatrix<dim> cut_cell_matrix;
  dealii::FullMatrix<double> cut_matrix{CutCellMatrix<dim>::n}; ///< of the cell that is added
  std::array<std::map<unsigned int, dealii::FullMatrix<double>>, 2> uncut_matrices; ///< by level

  std::vector<StokesCellElement> cells;
  std::vector<unsigned int> cut_elements;
  std::vector<CondensedIndices> cut_indices;
  std::vector<FaceElement> faces; ///< in the order of their first cells
};
} // namespace Gemmule
