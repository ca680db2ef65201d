// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/application/run_state.h>
#include <gemmule/output/named_arrays.h>

namespace Gemmule
{
namespace
{
  template <int dim>
  void exchange_samples(ArrayExchange &archive, InterfaceSamples<dim> &samples)
  {
    archive("time", samples.time);
    archive("points", samples.points);
    archive("f", samples.f);
    archive("f_total", samples.f_total);
    archive("composition", samples.composition);
    archive("tension", samples.tension);
    archive("chemical_potential", samples.chemical_potential);
    archive("curvature", samples.curvature);
    archive("weights", samples.weights);
    archive("velocity", samples.velocity);
    archive("normal", samples.normal);
    archive.integers("connectivity", samples.connectivity);
    static_assert(sizeof(InterfaceSamples<dim>) == sizeof(double) + 11 * sizeof(std::vector<double>),
                  "InterfaceSamples has a new member: give it a line above, then count it here");
  }
} // namespace

template <int dim>
void exchange(ArrayExchange &archive, RunState<dim> &state)
{
  archive.scope("system", [&] { exchange(archive, state.system); });
  archive.scope("step_control",
                [&]
                {
                  auto &memory = state.step_control;
                  archive("now", memory.now);
                  archive("wanted", memory.wanted);
                  archive("rejected_step", memory.rejected_step);
                  archive("rejected_error", memory.rejected_error);
                  archive("last_step", memory.last_step);
                  archive("floor", memory.floor);
                  archive("floor_passes", memory.floor_passes);
                  archive("n_started", memory.n_started);
                  static_assert(
                      sizeof(memory) == 7 * sizeof(double),
                      "StepControlMemory has a new member: give it a line above, then count it here");
                });

  std::vector<double> row = to_numbers(state.row);
  archive("row", row);
  state.row = to_statistics_row(row);
  archive.scope("membrane", [&] { exchange_samples(archive, state.membrane); });
  archive("membrane_is_written", state.membrane_is_written);
  archive("n_rejected", state.retries.n_rejected);
  archive("n_attempts", state.retries.n_attempts);
  archive("last_repair", state.retries.last_repair);
  static_assert(sizeof(state.retries) == 2 * sizeof(double),
                "RetryMemory has a new member: give it a line above, then count it here");
  archive("wall_time", state.wall_time);
  archive("n_interface_groups", state.n_interface_groups);
  archive("n_field_files", state.n_field_files);
}

template void exchange(ArrayExchange &, RunState<2> &);
template void exchange(ArrayExchange &, RunState<3> &);
} // namespace Gemmule
