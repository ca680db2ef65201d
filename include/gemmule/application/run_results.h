// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/application/output_schedule.h>
#include <gemmule/application/run_state.h>
#include <gemmule/coupling/coupled_system.h>
#include <gemmule/output/field_output.h>
#include <gemmule/output/interface_output.h>
#include <gemmule/output/provenance.h>
#include <gemmule/output/statistics.h>

#include <mpi.h>
#include <string>
#include <vector>

namespace Gemmule
{
/**
 * What a run writes of its accepted steps (statistics of each, membrane and fields when they are due), and
 * figures and membrane of the last of them. All functions that write throw DiskError when the disk does not
 * take it, and are collective.
 */
template <int dim>
class RunResults
{
public:
  /**
   * @param directory that the run may write to
   * @param schedule must outlive the object
   * @param resumed state of an earlier run there, whose results are continued; nullptr: begins new files
   */
  RunResults(const std::string &directory, MPI_Comm communicator, const Provenance &provenance,
             const OutputSchedule &schedule, const RunState<dim> *resumed);

  /**
   * Takes the state that @p system has computed last as that of the next step, or of the start, and writes a
   * row of the statistics.
   *
   * @param errors of the step
   * @param wall_time seconds of all runs so far
   */
  void report(const CoupledSystem<dim> &system, const StepErrors &errors, double wall_time);

  /** Membrane and fields of the reported state as far as they are due. @param system still has that state */
  void write_if_due(const CoupledSystem<dim> &system);

  /** The membrane of the reported state, unless it is in the file already. */
  void write_membrane();

  /** Figures of the last accepted step. */
  const StatisticsRow &row() const { return last_row; }

  /** Puts what the next run needs to continue into @p state. */
  void save(RunState<dim> &state) const;

  /** A warning for each file that lacks entries that @p resumed counts; on rank 0. */
  std::vector<std::string> missing_entries(const RunState<dim> &resumed) const;

private:
  const MPI_Comm communicator;
  const OutputSchedule &schedule;
  StatisticsWriter statistics;
  InterfaceWriter<dim> interface_writer;
  FieldWriter<dim> field_writer;

  StatisticsRow last_row;
  InterfaceSamples<dim> membrane;
  bool membrane_is_written = false;
};
} // namespace Gemmule
