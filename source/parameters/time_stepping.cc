// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/parameters/section.h>
#include <gemmule/parameters/time_stepping.h>

#include <deal.II/base/parameter_handler.h>

namespace Gemmule::Parameters
{
void TimeStepping::add_parameters(dealii::ParameterHandler &prm)
{
  Section section(prm, {"Time stepping"});
  section.add("Adaptive", adaptive,
              "Whether the step size follows the tolerance; if not, all steps have the initial size.");
  section.add(
      "Initial time step", initial_step,
      "Size of the first step (dimensionless time). It is made in five parts of 1/16, 1/16, 1/8, 1/4 and "
      "1/2 of it, since the first of them is of first order only.",
      Range::positive());
  section.add(
      "Smallest time step", smallest_step,
      "The simulation stops with a message if the tolerance asks for smaller steps (dimensionless time).",
      Range::positive());
  section.add("Largest time step", largest_step, "Steps never exceed this (dimensionless time).",
              Range::positive());
  section.add(
      "Tolerance", tolerance,
      "Local error of shape (length) and composition that a step may make (dimensionless). Steps that make "
      "a larger one are repeated with a smaller size.",
      Range::positive());
  section.add(
      "Largest growth factor", largest_growth,
      "A step is at most this many times as long as the one before (dimensionless). BDF2 with variable "
      "steps is stable up to 1+sqrt(2); source: Grigorieff (1983).",
      Range{1., 2.4, true});
  section.add("Largest capillary Courant number", interface_courant_number,
              "C in the limit dt <= C h Ca / max|sigma| of the explicit coupling of membrane and flow "
              "(dimensionless); without 'Tension implicitness' the membrane oscillates above about 0.7.",
              Range::positive());
  section.add(
      "Tension implicitness", tension_implicitness,
      "S, how much of the membrane's stiffness the flow takes implicitly: that of the tension against normal "
      "displacements, that of the regularisation 'compressibility' against dilatation, and that of bending "
      "(five times S of it). A term of order "
      "dt^2 that damps short waves (dimensionless). 0: explicit coupling, stable up to a capillary Courant "
      "number of about 0.7; 0.4: stable for larger ones.",
      Range{0., 10., false});
}

void TimeStepping::check() const
{
  TimeStepping copy(*this);
  dealii::ParameterHandler prm;
  copy.add_parameters(prm);

  if (!adaptive)
    return;
  const std::string order =
      ". The steps have to satisfy Smallest time step <= Initial time step <= Largest time step.";
  if (smallest_step > initial_step)
    throw ParameterError("Time stepping/Smallest time step",
                         "is " + to_text(smallest_step) +
                             ", larger than 'Initial time step' = " + to_text(initial_step) + order);
  if (initial_step > largest_step)
    throw ParameterError("Time stepping/Initial time step",
                         "is " + to_text(initial_step) +
                             ", larger than 'Largest time step' = " + to_text(largest_step) + order);
}
} // namespace Gemmule::Parameters
