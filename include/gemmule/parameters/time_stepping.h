// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace dealii
{
class ParameterHandler;
}

namespace Gemmule::Parameters
{
/** Section "Time stepping": step size control (doc/method.md, "Step size"). */
struct TimeStepping
{
  /** false: all steps have the size #initial_step. */
  bool adaptive = true;
  double initial_step = 1e-3;
  double smallest_step = 1e-7;
  double largest_step = 0.05;
  /** Local error of shape and composition that a step may make. */
  double tolerance = 1e-4;
  double largest_growth = 1.5;
  /** C of dt <= C h Ca / max|sigma|. */
  double interface_courant_number = 2.;
  /** S, part of the tension's stiffness against normal displacements that the flow takes implicitly; 0: none.
   */
  double tension_implicitness = 0.4;

  void add_parameters(dealii::ParameterHandler &prm);
  /** @throws ParameterError unless smallest <= initial <= largest step */
  void check() const;
};
} // namespace Gemmule::Parameters
