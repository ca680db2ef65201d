// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/application/retry_policy.h>
#include <gemmule/coupling/coupled_state.h>
#include <gemmule/output/interface_output.h>
#include <gemmule/output/statistics.h>
#include <gemmule/time/step_control.h>

namespace Gemmule
{
/** Everything that a run carries from one accepted step, or attempt at one, to the next. */
template <int dim>
struct RunState
{
  CoupledState<dim> system;
  StepControlMemory step_control;

  StatisticsRow row;                ///< of the last accepted step
  InterfaceSamples<dim> membrane;   ///< of the same
  bool membrane_is_written = false; ///< to interface.h5
  RetryMemory retries;
  double wall_time = 0.; ///< seconds of all runs so far

  // How much has been written, to notice what is missing.
  unsigned int n_interface_groups = 0;
  unsigned int n_field_files = 0;
};

/** Saves or restores all members. */
template <int dim>
void exchange(ArrayExchange &archive, RunState<dim> &state);
} // namespace Gemmule
