// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace dealii
{
class ParameterHandler;
}

namespace Gemmule::Parameters
{
/** Section "Checkpoint": when the state is saved, and when a run ends by the clock (doc/checkpoints.md). */
struct Checkpoint
{
  /** Accepted steps between two checkpoints; 0: none by the number of steps. */
  unsigned int steps_between = 0;
  /** Seconds of wall clock between two checkpoints; 0: none by the clock. */
  double wall_clock_interval = 300.;
  /** How many of the last checkpoints stay on disk. */
  unsigned int number_kept = 2;
  /** Seconds of wall clock after which the run saves its state and stops; 0: no limit. */
  double wall_time_limit = 0.;

  void add_parameters(dealii::ParameterHandler &prm);
  void check() const;
};
} // namespace Gemmule::Parameters
