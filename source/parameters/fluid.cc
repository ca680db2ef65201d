// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/fluid.h>
#include <gemmule/parameters/section.h>

#include <deal.II/base/parameter_handler.h>

namespace Gemmule::Parameters
{
void Fluid::add_parameters(dealii::ParameterHandler &prm)
{
  Section section(prm, {"Fluid"});
  section.add(
      "Capillary number", capillary_number,
      "Ca: viscous stress over membrane tension (dimensionless). The membrane acts on the fluid with the "
      "force -(1/Ca)(sigma kappa n - grad_s sigma). Source: Li, Lowengrub, Voigt (2012).",
      Range::positive());
  section.add(
      "Viscosity ratio", viscosity_ratio,
      "Viscosity of the fluid inside the membrane divided by that of the fluid outside (dimensionless).",
      Range::positive());
}

void Fluid::check() const
{
  Fluid copy(*this);
  dealii::ParameterHandler prm;
  copy.add_parameters(prm);
}
} // namespace Gemmule::Parameters
