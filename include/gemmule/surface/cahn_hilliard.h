// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/linear_system.h>
#include <gemmule/model/membrane_model.h>
#include <gemmule/surface/surface_step.h>

namespace Gemmule
{
template <int dim>
struct TraceCell;
template <int dim>
class TraceSpace;
namespace Parameters
{
  struct Surface;
}

/**
 * Phase separation on the moving membrane: concentration f and chemical potential mu by trace finite
 * elements, the conservative BDF and Newton's method (doc/method-surface.md):
 *
 *   (1/dt)(a0 int_n f v + a1 int_{n-1} f v + a2 int_{n-2} f v) - int_n f u.grad v
 *     + (1/Pe) int_n grad_s mu.grad_s v + (rho/h) [s(f, v) + (1/Pe) s(mu, v)] = 0
 *   int_n mu w - int_n (g_f + M gamma_f (+ M w_f)) w - C^2 int_n grad_s f.grad_s w - C^2 (rho/h) s(f, w) = 0
 *
 * with s(a, b) = int_active (n.grad a)(n.grad b), and w the bending energy, if there is one. Fully implicit,
 * hence E non-increasing for time steps that resolve the instability of the mixed state. Everything but g_f +
 * M gamma_f is linear, so that its linearisation error, known at each quadrature point, is the residual of
 * the whole system, and the mass is exact after every iteration.
 */
template <int dim>
class CahnHilliard
{
public:
  /** @p model and @p parameters are kept by reference. */
  CahnHilliard(const MembraneModel &model, const Parameters::Surface &parameters, MPI_Comm communicator);

  /**
   * f and mu at the end of @p step, for which @p space has been prepared.
   *
   * @param total_concentration fbar at the end of the step
   * Throws SimulationError if Newton's method does not converge. Collective.
   */
  void advance(const TraceSpace<dim> &space, const SurfaceStep<dim> &step,
               const TraceField<dim> &total_concentration);

  /**
   * Sets f to @p concentration and mu from its definition.
   * @param curvature at the quadrature points, for the bending energy's part of mu; nullptr for none
   * Collective.
   */
  void initialise(const TraceSpace<dim> &space, const TraceField<dim> &concentration,
                  const TraceField<dim> &total_concentration, const MembranePointValues *curvature = nullptr);

  const TraceField<dim> &concentration() const { return f; }
  const TraceField<dim> &chemical_potential() const { return mu; }

  /** Newton iterations (solves) of the last step. */
  unsigned int last_iterations() const { return n_iterations; }

private:
  using PointValues = MembranePointValues;

  void assemble_matrix(const TraceSpace<dim> &space, const SurfaceStep<dim> &step);
  LinearSystem::Vector assemble_rhs(const TraceSpace<dim> &space, const SurfaceStep<dim> &step) const;
  /** Linearises the local chemical potential about the present f at the points. */
  void linearise();
  /** Takes f at the points from @p field, and returns the linearisation error and the magnitude it compares
   * with. */
  std::pair<double, double> update_points(const TraceSpace<dim> &space, const TraceField<dim> &field);

  const MembraneModel &model;
  const Parameters::Surface &parameters;
  MPI_Comm communicator;
  LinearSystem system;
  TraceField<dim> f, mu;
  unsigned int n_iterations = 0;

  /** g_f + M gamma_f (+ M w_f) and its derivative at a point for the concentration @p value. */
  MembraneModel::ChemicalPotential local_potential(unsigned int cell, unsigned int q, double value) const;

  PointValues total_at_points, f_at_points;
  const PointValues *curvature_at_points = nullptr; ///< of the present call; nullptr without bending
  PointValues slope;                                ///< d(g_f + M gamma_f)/df where it was linearised
  PointValues intercept;                            ///< g_f + M gamma_f - slope f at the present f
};
} // namespace Gemmule
