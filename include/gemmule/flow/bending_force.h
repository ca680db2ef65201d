// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/membrane_force.h>
#include <gemmule/surface/membrane_bending.h>

namespace Gemmule
{
/**
 * Force of the bending energy E_b = int w(kappa, c) on the fluid: -(1/Ca) dE_b[<v>] with the variation of
 * E_b under the displacement v at fixed composition of each material point (design section 6, doc/model.md),
 *
 *   dE_b[v] = int grad_s m . (grad_s v)^T n - m grad_s n : grad_s v + w div_s v,   m = w_kappa = k (kappa -
 * kappa_0),
 *
 * in which only first derivatives of v and of the trace field m occur. In 2D grad_s n is kappa times the
 * tangential projection; in 3D its traceless part comes from the second derivatives of the level set.
 */
template <int dim>
class BendingForce
{
public:
  using Velocity = std::vector<MembraneVelocity<dim>>;

  /** @param bending curvature and moment on the membrane of @p geometry; both must stay as long as this is
   * used. */
  BendingForce(const MembraneBending<dim> &bending, const CutGeometry<dim> &geometry);

  /** Adds this rank's part of -(1/Ca) dE_b[<v>]. @p force holds the tangential gradients of the same
   * geometry. */
  void add_rhs(const MembraneForce<dim> &force, double capillary_number, const FluidPair &fluids,
               const std::vector<StokesCellElement> &cut_cell_elements, const ElementSystem &system,
               std::vector<double> &rhs) const;

  /** dE_b[velocity]: the power that bending takes up; this rank's part. */
  double power(const MembraneForce<dim> &force, const Velocity &velocity) const;

private:
  static constexpr unsigned int nv = StokesLayout<dim>::n_velocity_nodes;

  /** dE_b[phi_i e_c] on cut cell @p k, [i][c]. */
  std::array<dealii::Tensor<1, dim>, nv> variation(const MembraneForce<dim> &force, unsigned int k) const;

  const MembraneBending<dim> &bending;
  const CutGeometry<dim> &geometry;
};
} // namespace Gemmule
