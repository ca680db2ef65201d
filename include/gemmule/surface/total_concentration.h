// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/surface/surface_step.h>

#include <memory>
#include <mpi.h>

namespace Gemmule
{
class MembraneModel;
template <int dim>
class TraceSpace;
namespace Parameters
{
  struct Surface;
}

/** How the total concentration fbar gets from one time level to the next: one subclass per scheme. */
template <int dim>
class TotalConcentration
{
public:
  virtual ~TotalConcentration() = default;

  /** fbar at the end of @p step, for which @p space has been prepared. Throws SimulationError. Collective. */
  virtual TraceField<dim> advance(const TraceSpace<dim> &space, const SurfaceStep<dim> &step) = 0;

  /** The constant that the last step added to keep the mass exact; 0 for schemes that are exact by
   * themselves. */
  virtual double last_shift() const { return 0.; }

  /** Does advance() read the predicted and the extended total concentrations of the step? */
  virtual bool needs_extended_fields() const { return false; }

  /** The scheme for the regularisation of @p model. */
  static std::unique_ptr<TotalConcentration>
  create(const MembraneModel &model, const Parameters::Surface &parameters, MPI_Comm communicator);
};
} // namespace Gemmule
