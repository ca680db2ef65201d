// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/application/reporting.h>
#include <gemmule/application/run_results.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <limits>

namespace Gemmule
{
using namespace dealii;

namespace
{
  template <int dim>
  double time_of(const RunState<dim> *const resumed)
  {
    return resumed != nullptr ? resumed->row.time : -std::numeric_limits<double>::infinity();
  }

  /** What only two steps together tell. */
  void compare_with_previous(StatisticsRow &row, const StatisticsRow &previous)
  {
    row.step = row.time > 0. ? previous.step + 1 : 0;
    row.time_step_size = row.time - previous.time;
    if (row.step == 0)
      return;
    const auto dissipation = [](const StatisticsRow &r)
    { return r.dissipation_viscous + r.dissipation_phase; };
    const double dissipated = 0.5 * row.time_step_size * (dissipation(row) + dissipation(previous));
    row.energy_balance_error =
        (row.energy_total - previous.energy_total + dissipated) / std::max(dissipated, 1e-300);
  }
} // namespace

template <int dim>
RunResults<dim>::RunResults(const std::string &directory, const MPI_Comm communicator,
                            const Provenance &provenance, const OutputSchedule &schedule,
                            const RunState<dim> *const resumed)
    : communicator(communicator), schedule(schedule), statistics(directory, communicator, time_of(resumed)),
      interface_writer(directory, communicator, provenance, time_of(resumed)),
      field_writer(directory, communicator, provenance, resumed != nullptr ? resumed->n_field_files : 0)
{
  if (resumed == nullptr)
    return;
  last_row = resumed->row;
  membrane = resumed->membrane;
  membrane_is_written = resumed->membrane_is_written;
}

template <int dim>
void RunResults<dim>::report(const CoupledSystem<dim> &system, const StepErrors &errors,
                             const double wall_time)
{
  const StatisticsRow previous_row = last_row;
  membrane_is_written = false;
  membrane = sample_membrane(system);
  last_row = make_statistics(system, membrane);
  compare_with_previous(last_row, previous_row);
  last_row.wall_time = wall_time;
  last_row.time_error_shape = errors.shape;
  last_row.time_error_composition = errors.composition;
  statistics.write(last_row);
}

template <int dim>
void RunResults<dim>::write_if_due(const CoupledSystem<dim> &system)
{
  if (schedule.membrane_is_due(last_row.time))
    write_membrane();
  if (schedule.fields_are_due(last_row.time))
    write_fields(system, last_row.time, field_writer);
}

template <int dim>
void RunResults<dim>::write_membrane()
{
  if (!membrane_is_written)
    interface_writer.write(membrane);
  membrane_is_written = true;
}

template <int dim>
void RunResults<dim>::save(RunState<dim> &state) const
{
  state.row = last_row;
  state.membrane = membrane;
  state.membrane_is_written = membrane_is_written;
  state.n_interface_groups = interface_writer.n_groups();
  state.n_field_files = field_writer.n_files();
}

template <int dim>
std::vector<std::string> RunResults<dim>::missing_entries(const RunState<dim> &resumed) const
{
  std::vector<std::string> warnings;
  // What is known on rank 0 only is compared there only.
  if (Utilities::MPI::this_mpi_process(communicator) != 0)
    return warnings;
  const auto compare = [&](const std::string &what, const std::size_t present, const std::size_t written)
  {
    if (present != written)
      warnings.push_back(what + " has " + std::to_string(present) + " of the " + std::to_string(written) +
                         " entries that had been written up to the checkpoint; the rest is missing or "
                         "damaged.");
  };
  compare("statistics.csv", statistics.n_rows(), resumed.row.step + 1);
  compare("interface.h5", interface_writer.n_groups(), resumed.n_interface_groups);
  compare("solution.xdmf", field_writer.n_listed(), resumed.n_field_files);
  return warnings;
}

template class RunResults<2>;
template class RunResults<3>;
} // namespace Gemmule
