// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/flow/extra_field.h>
#include <gemmule/flow/extra_field_preconditioner.h>
#include <gemmule/flow/interface_velocity.h>

#include <memory>

namespace Gemmule
{
/** What a FlowTerm works on. */
template <int dim>
struct FlowTermContext
{
  const InterfaceVelocity<dim> &interface_velocity;
  LinearSystem &system;
  /** Of a term with an extra field; nullptr otherwise. */
  const ExtraField<dim> *extra_field;
};

/**
 * A term of the flow problem that lives on the membrane: a force, a stiffness that is implicit in the flow, a
 * constraint. The flow problem itself knows nothing of tension or bending (StokesSolver); what drives it is a
 * list of these. A term owns what it needs, so that it may outlive those who made it.
 *
 * A tension that is an unknown is a term with an extra field; a constraint with a single multiplier is one
 * with a unit force.
 */
template <int dim>
class FlowTerm
{
public:
  using Vector = LinearSystem::Vector;
  using Velocity = typename InterfaceVelocity<dim>::Velocity;

  virtual ~FlowTerm() = default;

  /** The space of a trace field that becomes a further unknown of the system; nullptr: none. */
  virtual const TraceSpace<dim> *extra_field_space() const { return nullptr; }

  /**
   * What an iterative solver takes for the Schur complement of the extra field; nullptr: its block of the
   * matrix, which is good where the field has little effect on itself by way of the flow. Collective.
   */
  virtual std::unique_ptr<ExtraFieldPreconditioner>
  extra_field_preconditioner(const FluidPair & /*fluids*/) const
  {
    return nullptr;
  }

  /** Adds to the matrix, and to @p right_side what that makes of velocities at the walls. */
  virtual void add_matrix(const FlowTermContext<dim> &, Vector & /*right_side*/) const {}

  /** Adds this rank's part of the right side. Collective. */
  virtual void add_right_side(const FlowTermContext<dim> &, Vector & /*right_side*/) const {}

  /** Is there a force whose amplitude follows from the flow? The flow of a unit of it is solved for besides.
   */
  virtual bool has_unit_force() const { return false; }
  /** Adds this rank's part of that force with amplitude one. */
  virtual void add_unit_force(const FlowTermContext<dim> &, Vector & /*right_side*/) const {}

  /** What is known when the amplitude is asked for. */
  struct Response
  {
    const Velocity &velocity;      ///< <u> without the force
    const Velocity &unit_velocity; ///< <u> by a unit of the force alone
    double unit_power;             ///< of the unit force on its own flow, not negative
  };
  /** The amplitude. Collective. */
  virtual double find_amplitude(const FlowTermContext<dim> &, const Response &) { return 0.; }

  /** Reads from the solution what others ask the term for later. Collective. */
  virtual void read(const FlowTermContext<dim> &, const Vector & /*solution*/) {}

  /** The power that the term's force takes from a flow (that it puts in with the other sign): this rank's
   * part. */
  virtual double power(const InterfaceVelocity<dim> &, const Velocity &) const { return 0.; }
};
} // namespace Gemmule
