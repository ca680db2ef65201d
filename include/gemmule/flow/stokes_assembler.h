// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/element_system.h>
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
  unsigned int element;  ///< in the ElementSystem
  CellLocation location; ///< cut: the element holds both fluids, inside first
};

/**
 * Puts the doubled Taylor-Hood discretisation of design section 2 into a symmetric ElementSystem: one element
 * per uncut cell, one with both fluids per cut cell, and for each fluid and ghost-penalty face one element
 * per velocity component and one for the pressure (which do not couple).
 */
template <int dim>
class StokesAssembler
{
public:
  using Layout = StokesLayout<dim>;

  StokesAssembler(const UnfittedStokesSpace<dim> &space, const Parameters::Fluid &fluid,
                  const Parameters::Flow &discretisation);

  /**
   * Starts the system with the elements for the position of the membrane for which the space was numbered.
   * More elements, and then ElementSystem::finish_elements(), may follow before assemble().
   * @param n_additional_unknowns room for unknowns of others, after those of the flow
   */
  void add_elements(const CutGeometry<dim> &geometry, ElementSystem &system,
                    unsigned int n_additional_unknowns = 0);

  /** Sets the matrix to that of the flow. */
  void assemble(const CutGeometry<dim> &geometry, ElementSystem &system);

  /** Right side due to the velocity on the boundary: this rank's part. */
  const std::vector<double> &boundary_rhs() const { return rhs; }

  /** Elements of all locally owned cells in the order of the mesh. */
  const std::vector<StokesCellElement> &cell_elements() const { return cells; }
  /** Elements of the cut cells, in the order of CutGeometry::cut_cells(). */
  const std::vector<StokesCellElement> &cut_cell_elements() const { return cut_cells; }

  const FluidPair &fluids() const { return pair; }

private:
  struct FaceElement
  {
    const InteriorFace *face;
    unsigned int fluid;
    unsigned int first_element; ///< dim velocity components, then the pressure
  };

  void add_cell_elements(const CutGeometry<dim> &geometry, ElementSystem &system);
  void add_face_elements(const CutGeometry<dim> &geometry, ElementSystem &system);
  void add_cell_matrices(const CutGeometry<dim> &geometry, ElementSystem &system);
  void add_face_matrices(ElementSystem &system);
  const dealii::FullMatrix<double> &uncut_cell_matrix(unsigned int cell, unsigned int fluid);

  const UnfittedStokesSpace<dim> &space;
  FluidPair pair;
  StokesReferenceMatrices<dim> reference;
  CutCellMatrix<dim> cut_cell_matrix;
  std::array<std::map<unsigned int, dealii::FullMatrix<double>>, 2> uncut_matrices; ///< by level

  std::vector<StokesCellElement> cells;
  std::vector<StokesCellElement> cut_cells;
  std::vector<FaceElement> faces;
  std::vector<double> rhs;
};
} // namespace Gemmule
