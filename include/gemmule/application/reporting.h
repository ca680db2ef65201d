// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/coupling/coupled_system.h>
#include <gemmule/output/field_output.h>
#include <gemmule/output/interface_output.h>
#include <gemmule/output/statistics.h>

namespace Gemmule
{
/**
 * All quadrature points of the membrane with the values there, complete on every rank; in 2D ordered along
 * its closed curves. Collective.
 */
template <int dim>
InterfaceSamples<dim> sample_membrane(const CoupledSystem<dim> &system);

/**
 * The figures of the last state that was computed. Leaves open what only the time loop knows: step number,
 * wall time, error estimates, energy balance. Collective.
 */
template <int dim>
StatisticsRow make_statistics(const CoupledSystem<dim> &system, const InterfaceSamples<dim> &membrane);

/** Writes velocity, pressure, level set, refinement level and subdomain of all cells. Collective. */
template <int dim>
void write_fields(const CoupledSystem<dim> &system, double time, FieldWriter<dim> &writer);
} // namespace Gemmule
