// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vector>

namespace dealii
{
class ParameterHandler;
}

namespace Gemmule::Parameters
{
/** Section "Output": how often what is written (doc/output.md). */
struct Output
{
  /** Simulated time between two outputs of velocity and pressure; 0: none. */
  double field_interval = 0.5;
  /** Simulated time between two outputs of the membrane; 0: none. */
  double interface_interval = 0.1;
  /** More times at which both are written; the steps hit them exactly. */
  std::vector<double> output_times;
  /** Whether to print a line per time step. */
  bool progress = true;

  void add_parameters(dealii::ParameterHandler &prm);
  void check() const;
};
} // namespace Gemmule::Parameters
