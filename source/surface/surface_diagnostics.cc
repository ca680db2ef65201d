// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/model/membrane_model.h>
#include <gemmule/surface/surface_diagnostics.h>
#include <gemmule/surface/trace_forms.h>

#include <deal.II/base/mpi.h>

#include <limits>

namespace Gemmule
{
using namespace dealii;

template <int dim>
SurfaceDiagnostics
compute_surface_diagnostics(const MembraneModel &model, const CutGeometry<dim> &geometry,
                            const TraceField<dim> &concentration, const TraceField<dim> &total_concentration,
                            const TraceField<dim> &chemical_potential, const MPI_Comm communicator)
{
  std::array<double, 5> sums{};
  std::array<double, 6> largest; // of f, -f, fbar, -fbar, c, -c
  largest.fill(-std::numeric_limits<double>::max());
  const double dissipation_factor = 1. / (model.mach_number() * model.peclet_number());
  SurfacePoint<dim> point;
  for (unsigned int k = 0; k < geometry.cut_cells().size(); ++k)
  {
    const auto &cell = geometry.cut_cells()[k];
    for (unsigned int q = 0; q < cell.surface_points.size(); ++q)
    {
      point.reinit(cell, q);
      const double weight = cell.surface_weights[q];
      const double f = point.value(concentration[k]), total = point.value(total_concentration[k]);
      const double c = f / total;
      sums[0] += weight * f;
      sums[1] += weight * total;
      sums[2] += weight * model.surface_energy_density(f, total);
      sums[3] += weight *
                 model.phase_energy_density(f, total, point.surface_gradient(concentration[k]).norm_square());
      sums[4] += weight * dissipation_factor * point.surface_gradient(chemical_potential[k]).norm_square();
      const std::array<double, 6> candidates{{f, -f, total, -total, c, -c}};
      for (unsigned int i = 0; i < candidates.size(); ++i)
        largest[i] = std::max(largest[i], candidates[i]);
    }
  }
  Utilities::MPI::sum(ArrayView<const double>(sums.data(), sums.size()), communicator,
                      ArrayView<double>(sums.data(), sums.size()));
  Utilities::MPI::max(ArrayView<const double>(largest.data(), largest.size()), communicator,
                      ArrayView<double>(largest.data(), largest.size()));

  SurfaceDiagnostics result;
  result.mass_f = sums[0];
  result.mass_total = sums[1];
  result.energy_surface = sums[2];
  result.energy_phase = sums[3];
  result.dissipation_phase = sums[4];
  result.concentration_max = largest[0];
  result.concentration_min = -largest[1];
  result.total_concentration_max = largest[2];
  result.total_concentration_min = -largest[3];
  result.composition_max = largest[4];
  result.composition_min = -largest[5];
  return result;
}

template SurfaceDiagnostics compute_surface_diagnostics(const MembraneModel &, const CutGeometry<2> &,
                                                        const TraceField<2> &, const TraceField<2> &,
                                                        const TraceField<2> &, MPI_Comm);
template SurfaceDiagnostics compute_surface_diagnostics(const MembraneModel &, const CutGeometry<3> &,
                                                        const TraceField<3> &, const TraceField<3> &,
                                                        const TraceField<3> &, MPI_Comm);
} // namespace Gemmule
