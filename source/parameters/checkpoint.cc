// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/checkpoint.h>
#include <gemmule/parameters/section.h>

#include <deal.II/base/parameter_handler.h>

namespace Gemmule::Parameters
{
void Checkpoint::add_parameters(dealii::ParameterHandler &prm)
{
  Section section(prm, {"Checkpoint"});
  section.add("Steps between checkpoints", steps_between,
              "The state is saved after this many accepted time steps; 0: not by their number.");
  section.add(
      "Wall clock interval", wall_clock_interval,
      "The state is saved when this much time has gone by since the last time (seconds of wall "
      "clock); 0: not by the clock. It is always saved at the end, on a signal and when a step fails.",
      Range::non_negative());
  section.add(
      "Number of checkpoints kept", number_kept,
      "How many of the last checkpoints stay on disk. If the newest is damaged, --resume takes the one "
      "before.",
      Range::at_least(1));
  section.add(
      "Wall time limit", wall_time_limit,
      "After this time the run finishes its step, saves its state and stops with exit code 3 (seconds "
      "of wall clock since it was started or resumed); 0: no limit. Leave the batch system's limit "
      "enough room for one step and one checkpoint.",
      Range::non_negative());
}

void Checkpoint::check() const
{
  Checkpoint copy(*this);
  dealii::ParameterHandler prm;
  copy.add_parameters(prm);
}
} // namespace Gemmule::Parameters
