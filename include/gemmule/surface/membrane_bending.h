// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/algebra/linear_system.h>
#include <gemmule/model/bending_law.h>
#include <gemmule/surface/trace_space.h>

#include <memory>

namespace Gemmule
{
/**
 * Curvature and bending moment of the membrane in the trace space (Q2), from weak forms with first
 * derivatives only (doc/method-surface.md; Dziuk 2008 for the curvature vector):
 *
 *   int K.w + h int_active (n.grad K).(n.grad w) = int (I - n n^T) : grad w      for all vectors w,
 *   int m v + h int_active (n.grad m)(n.grad v) = int k(c) (kappa - kappa_0(c)) v  for all v,   kappa = K.n.
 *
 * The right side of the first is the variation of the length of the membrane in the direction w, so that
 * kappa sees every displacement that changes the length, also those as short as a cell.
 */
template <int dim>
class MembraneBending
{
public:
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;
  using PointValues = MembranePointValues;

  /** @p law is kept by reference. */
  MembraneBending(const dealii::Triangulation<dim> &triangulation, const BendingLaw &law);

  /** Call after every change of the mesh. Collective. */
  void reinit_mesh();

  /**
   * Curvature of the membrane, whose cut cells must stay until the next call. Throws SimulationError.
   * Collective.
   */
  void compute_curvature(const Interface<dim> &interface);

  /**
   * Moment and energy for the concentrations on the cut cells; nullptr stands for composition 0 everywhere.
   * Needs compute_curvature(). Collective.
   */
  void compute_moment(const TraceField<dim> *concentration, const TraceField<dim> *total_concentration);

  /** kappa at the quadrature points of the locally owned cut cells. */
  const PointValues &curvature() const { return curvature_at_points; }
  /** m = k (kappa - kappa_0) as a trace field. */
  const TraceField<dim> &moment() const { return moment_field; }
  /** k (kappa - kappa_0) and w at the quadrature points. */
  const PointValues &moment_at_points() const { return moments; }
  const PointValues &energy_density() const { return energies; }

  /** w - m kappa = (k/2)(kappa_0^2 - kappa^2): what multiplies div_s v in the force in 2D. */
  PointValues tension() const;

  /** int w over the membrane, without the part of the grid-scale rigidity, on all ranks. */
  double energy() const { return total_energy; }

  /** Largest numerical rigidity that negative tension has asked for somewhere on the membrane, on all ranks.
   */
  double largest_numerical_rigidity() const { return numerical_rigidity; }

  /** The space of curvature and moment on the cut cells. */
  const TraceSpace<dim> &trace_space() const { return space; }
  /** The same, for those that outlive this. */
  std::shared_ptr<const TraceSpace<dim>> shared_trace_space() const { return shared_space; }
  const BendingLaw &get_law() const { return law; }

private:
  void assemble_mass_matrix();

  const BendingLaw &law;
  const std::shared_ptr<TraceSpace<dim>> shared_space;
  TraceSpace<dim> &space;
  LinearSystem system;
  PointValues curvature_at_points, moments, energies;
  TraceField<dim> moment_field;
  double total_energy = 0., numerical_rigidity = 0.;
};
} // namespace Gemmule
