// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/stokes_assembler.h>
#include <gemmule/flow/stokes_solution.h>

#include <vector>

namespace Gemmule
{
/** Estimated error of a flow, by cells. */
struct FlowErrorEstimate
{
  /** Squares of the cells' shares in the energy norm, by position in UnfittedStokesSpace::owned_cells(). */
  std::vector<double> squares;
  /** Square of the energy norm of the flow itself, over both fluids and all ranks. */
  double norm_square = 0.;
};

/**
 * Residual-based estimate (Kelly's jumps and the residuals in the cells) of the error of the flow in the
 * energy norm
 * ||e||^2 = sum_i int_i 2 eta_i |D(e)|^2. The share of a cell K of size h is, with the stress T = 2 eta D(u)
 * - p I,
 *
 *   sum_i 1/2 (h / 4 eta_i) sum_F int_{F, fluid i} |[T_i n]|^2
 *       + int_{K, fluid i} (h^2 / 4 eta_i) |div T_i|^2 + eta_i (div u_i)^2   +   (eta_Gamma / h) int_Gamma
 * |[u]|^2.
 *
 * Integrals are over the parts that the fluids occupy, cut cells included. For quadratic elements the
 * residual in the cells is the larger part where the flow is smooth. The jump of the stress across the
 * membrane is not compared with its force: there the other criteria decide. Constant factors are those of
 * quadratic elements, not of a guaranteed bound.
 */
template <int dim>
class FlowErrorEstimator
{
public:
  using Layout = StokesLayout<dim>;

  /** Collective. */
  static FlowErrorEstimate estimate(const UnfittedStokesSpace<dim> &space, const CutGeometry<dim> &geometry,
                                    const StokesAssembler<dim> &assembler,
                                    const StokesSolution<dim> &solution);
};
} // namespace Gemmule
