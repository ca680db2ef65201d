// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/surface/cahn_hilliard.h>
#include <gemmule/surface/surface_diagnostics.h>
#include <gemmule/surface/total_concentration.h>
#include <gemmule/surface/trace_space.h>

#include <deal.II/base/function.h>

#include <memory>
#include <vector>

namespace Gemmule
{
class MembraneModel;
namespace Parameters
{
  struct Surface;
}

/**
 * The surface equations of one time step: total concentration, then concentration and chemical potential
 * (doc/method-surface.md), and what follows from them: tension, energies, masses and the cloud
 * that later steps need. Nothing is carried from step to step in here: all memory is in the clouds and fields
 * that SurfaceStep hands over, so that a step can be repeated, or continued on another mesh.
 */
template <int dim>
class SurfaceSolver
{
public:
  /** @p model and @p parameters are kept by reference. */
  SurfaceSolver(const dealii::Triangulation<dim> &triangulation, const MembraneModel &model,
                const Parameters::Surface &parameters);

  /** Call after every change of the mesh. Collective. */
  void reinit_mesh();

  /**
   * Projects the initial concentrations, and computes mu from its definition.
   * @param curvature at the quadrature points, nullptr without bending
   * Collective.
   */
  void initialise(const Interface<dim> &interface, const dealii::Function<dim> &concentration,
                  const dealii::Function<dim> &total_concentration,
                  const MembranePointValues *curvature = nullptr);

  /**
   * Takes the fields to the membrane of @p interface, that of the end of @p step.
   *
   * The interface must live until the next call. Throws SimulationError if Newton's method does not converge,
   * a concentration cannot be continued, or the membrane left the box. Collective.
   */
  void advance(const Interface<dim> &interface, const SurfaceStep<dim> &step);

  const TraceField<dim> &concentration() const { return phases.concentration(); }
  const TraceField<dim> &total_concentration() const { return total; }
  const TraceField<dim> &chemical_potential() const { return phases.chemical_potential(); }

  /**
   * Tension without arclength constraint, for each locally owned cut cell at its quadrature points.
   * @param curvature with which mu has been computed; nullptr without bending
   */
  MembranePointValues tension(const MembranePointValues *curvature = nullptr) const;

  const SurfaceDiagnostics &diagnostics() const { return figures; }

  /** The locally owned part of the membrane; complete it over the ranks before it is used in a SurfaceStep.
   */
  MembraneCloud<dim> cloud() const;

  /** Must SurfaceStep have the predicted and the extended total concentrations? */
  bool needs_extended_fields() const { return transport->needs_extended_fields(); }

  /** Unknowns of f, fbar and mu together, on all ranks. */
  unsigned int n_unknowns() const { return 3 * space.n_unknowns(); }
  unsigned int last_newton_iterations() const { return phases.last_iterations(); }
  /** Constant added to fbar in the last step to keep its mass (update smoothing; otherwise 0). */
  double last_mass_shift() const { return transport->last_shift(); }

private:
  void compute_diagnostics();

  const MembraneModel &model;
  TraceSpace<dim> space;
  std::unique_ptr<TotalConcentration<dim>> transport;
  CahnHilliard<dim> phases;
  TraceField<dim> total;
  SurfaceDiagnostics figures;
};
} // namespace Gemmule
