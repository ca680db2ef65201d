// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/surface/surface_step.h>

#include <mpi.h>

namespace Gemmule
{
class MembraneModel;
template <int dim>
class CutGeometry;

/** What the statistics report about the surface fields; all over the membrane, on all ranks (dimensionless).
 */
struct SurfaceDiagnostics
{
  double mass_f = 0.;            ///< int f
  double mass_total = 0.;        ///< int fbar
  double energy_surface = 0.;    ///< int gamma, with the compressibility energy if there is one
  double energy_phase = 0.;      ///< (1/M) int g + C^2/2 |grad_s f|^2
  double dissipation_phase = 0.; ///< (1/(M Pe)) int |grad_s mu|^2
  double concentration_min = 0.; ///< extrema are those at the quadrature points
  double concentration_max = 0.;
  double total_concentration_min = 0.;
  double total_concentration_max = 0.;
  double composition_min = 0.; ///< c = f / fbar
  double composition_max = 0.;
};

/** Collective. */
template <int dim>
SurfaceDiagnostics
compute_surface_diagnostics(const MembraneModel &model, const CutGeometry<dim> &geometry,
                            const TraceField<dim> &concentration, const TraceField<dim> &total_concentration,
                            const TraceField<dim> &chemical_potential, MPI_Comm communicator);
} // namespace Gemmule
