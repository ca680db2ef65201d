// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/tensor_lagrange.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/la_parallel_vector.h>

#include <array>
#include <vector>

namespace Gemmule
{
/** One number per quadrature point of the membrane: [locally owned cut cell][point], as in CutGeometry. */
using MembranePointValues = std::vector<std::vector<double>>;

/** Points per direction of the Gauss rules that the rules of cut cells are made of. */
constexpr unsigned int n_cut_gauss_points = 4;

enum class CellLocation : unsigned char
{
  inside,  ///< the whole cell lies in the vesicle (fluid 1)
  outside, ///< the whole cell lies in the surrounding fluid (fluid 2)
  cut      ///< the membrane passes through the cell
};

/** A cell that the membrane cuts, with the quadrature rules of its three parts. */
template <int dim>
struct CutCell
{
  using LevelSetBasis = TensorLagrange<dim, 3>;

  unsigned int active_cell_index; ///< as dealii::CellAccessor::active_cell_index()
  dealii::Point<dim> corner;      ///< lower corner
  double size;                    ///< edge length h

  std::array<double, LevelSetBasis::n> level_set; ///< nodal values of phi, lexicographic

  /** Bulk rules: [0] inside (fluid 1), [1] outside (fluid 2). Unit coordinates; weights carry h^dim. */
  std::array<std::vector<dealii::Point<dim>>, 2> bulk_points;
  std::array<std::vector<double>, 2> bulk_weights;

  /** Rule on the membrane: unit coordinates; weights are lengths (areas in 3D); n = grad phi / |grad phi|. */
  std::vector<dealii::Point<dim>> surface_points;
  std::vector<double> surface_weights;
  std::vector<dealii::Tensor<1, dim>> normals;

  /** Physical coordinates of the unit point @p p. */
  dealii::Point<dim> physical(const dealii::Point<dim> &p) const
  {
    return corner + size * dealii::Tensor<1, dim>(p);
  }
};

/**
 * Where the membrane (zero set of the Q3 level set, negative inside) cuts the mesh, and the quadrature rules
 * of the cut cells; computed once per step and shared by the surface equations and the flow (doc/method.md,
 * "One time step").
 *
 * Cells are located by the Bernstein coefficients of phi and confirmed by the rules themselves, so that a
 * membrane that enters a cell between two nodes is found. Rules: dealii::NonMatching::QuadratureGenerator
 * with four Gauss points per direction. On each rank: rules for the locally owned cells, locations also for
 * ghost cells.
 */
template <int dim>
class CutGeometry
{
public:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;

  explicit CutGeometry(unsigned int n_gauss_points = n_cut_gauss_points);

  /**
   * Cuts the cells. @p level_set must be ghosted and satisfy the hanging-node constraints.
   * @throws SimulationError on all ranks when an assertion of the generator of rules fails (debug version of
   * deal.II). Collective.
   */
  void reinit(const dealii::DoFHandler<dim> &dof_handler, const Vector &level_set);

  /** By active_cell_index; meaningless for artificial cells. */
  CellLocation location(unsigned int active_cell_index) const { return locations[active_cell_index]; }

  /** Does fluid @p fluid (0 inside, 1 outside) occupy a part of the cell? */
  bool is_active(unsigned int active_cell_index, unsigned int fluid) const
  {
    const auto l = locations[active_cell_index];
    return l == CellLocation::cut || (l == CellLocation::inside) == (fluid == 0);
  }

  /** The locally owned cut cells, in the order of the mesh. */
  const std::vector<CutCell<dim>> &cut_cells() const { return cells; }

  /** The locally owned cut cell with that index, or nullptr. */
  const CutCell<dim> *find(unsigned int active_cell_index) const
  {
    const int i = cut_cell_of[active_cell_index];
    return i < 0 ? nullptr : &cells[i];
  }

  /** Length (2D) or area (3D) of the membrane, summed over the ranks. */
  double measure() const { return total_measure; }

  /** Area (2D) or volume (3D) that the membrane encloses, summed over the ranks. */
  double enclosed_volume() const { return total_enclosed_volume; }

private:
  unsigned int n_gauss_points;
  std::vector<CellLocation> locations;
  std::vector<int> cut_cell_of;
  std::vector<CutCell<dim>> cells;
  double total_measure = 0.;
  double total_enclosed_volume = 0.;
};
} // namespace Gemmule
