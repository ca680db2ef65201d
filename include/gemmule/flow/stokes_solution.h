// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/stokes_assembler.h>

#include <deal.II/lac/la_parallel_vector.h>

#include <array>
#include <vector>

namespace Gemmule
{
/**
 * Velocity and pressure of both fluids on the locally owned cells, and what is integrated from them over the
 * parts of the cells that each fluid occupies. Pressures have zero mean over the box.
 */
template <int dim>
class StokesSolution
{
public:
  using Layout = StokesLayout<dim>;
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;
  using Local = std::array<double, Layout::n>;

  /** Takes the solution of the reduced system, ghosted, apart. The arguments must stay as long as this is
   * used. Collective. */
  void reinit(const UnfittedStokesSpace<dim> &space, const CutGeometry<dim> &geometry,
              const StokesAssembler<dim> &assembler, const LinearSystem &system,
              const LinearSystem::Vector &unknowns);

  /** (Ca/2) int eta |grad u + grad u^T|^2 over both fluids. Collective. */
  double viscous_dissipation(double capillary_number) const;

  /** Largest nodal speed on the physical side of the membrane. Collective. */
  double max_velocity() const;

  /**
   * A vector on the Taylor-Hood DoFHandler with, for each dof, the value in the fluid at its support point.
   * Ghosted. Collective.
   */
  void interpolate(Vector &values) const;

  /** Values of both fluids in the order of StokesLayout, by position in StokesAssembler::cell_elements();
   * those of a fluid that the cell does not hold have no meaning. */
  const std::array<Local, 2> &cell_values(const unsigned int position) const { return local[position]; }

private:
  /** Fluid at each support point of a cut cell: by the sign of the cubic level set. */
  std::array<unsigned char, Layout::n> fluid_at_nodes(const CutCell<dim> &cell) const;
  double integrate_pressure() const;

  const UnfittedStokesSpace<dim> *space = nullptr;
  const CutGeometry<dim> *geometry = nullptr;
  const StokesAssembler<dim> *assembler = nullptr;
  /** By position in StokesAssembler::cell_elements(), both fluids; unused ones have no meaning. */
  std::vector<std::array<Local, 2>> local;
};
} // namespace Gemmule
