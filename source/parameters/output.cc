// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/output.h>
#include <gemmule/parameters/section.h>

#include <deal.II/base/parameter_handler.h>

namespace Gemmule::Parameters
{
void Output::add_parameters(dealii::ParameterHandler &prm)
{
  Section section(prm, {"Output"});
  section.add("Field output interval", field_interval,
              "Simulated time between two outputs of velocity and pressure in the box (dimensionless time); "
              "the last one is at the end. 0: only at 'Output times'.",
              Range::non_negative());
  section.add(
      "Interface output interval", interface_interval,
      "Simulated time between two outputs of the membrane and its fields (dimensionless time); 0: only at "
      "'Output times' and at the end.",
      Range::non_negative());
  section.add("Output times", output_times,
              "More times at which both are written (dimensionless time); the time steps hit them exactly.",
              Range::non_negative());
  section.add(
      "Progress line", progress,
      "Whether to show how far the run is: on a terminal in one line that is rewritten, otherwise in a line "
      "at most every ten seconds.");
}

void Output::check() const
{
  Output copy(*this);
  dealii::ParameterHandler prm;
  copy.add_parameters(prm);
}
} // namespace Gemmule::Parameters
