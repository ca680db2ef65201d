// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace dealii
{
class ParameterHandler;
}

namespace Gemmule::Parameters
{
/** Where the tension of the membrane comes from. */
enum class TensionModel
{
  phase_field, ///< computed from the concentrations of the phases
  prescribed   ///< a given function of space and time; no surface transport is solved
};

/** Section "Membrane": initial state, energies and dimensionless numbers of the membrane (doc/model.md,
 * "Membrane"). */
struct Membrane
{
  /** Expression, negative inside; its zero set is the initial membrane. */
  std::string level_set = "x^2+2*y^2-0.25";
  TensionModel tension_model = TensionModel::phase_field;
  /** Expression sigma(x, y(, z), t) for TensionModel::prescribed. */
  std::string prescribed_tension = "1";
  /** Expression for f(0), the concentration of one phase. */
  std::string initial_concentration = "0.5+0.01*(sin(x)*cos(y)+sin(4*x)*cos(3*y))";
  /** Expression for the total concentration at t = 0. */
  std::string initial_total_concentration = "1";
  /** Pe: advection over surface diffusion; f_t + ... = (1/Pe) Laplace_s mu. */
  double peclet_number = 1.;
  /** C: thickness of a phase boundary; 10-90 % width 6.2 C. */
  double cahn_number = 0.02;
  /** M: surface energy over energy of the phase boundaries. */
  double mach_number = 1.;
  /** Names in the registries of membrane energies; the names are checked where the registries are. */
  std::string double_well = "quartic";
  std::string surface_energy = "exponential";
  /** x in gamma = exp(-x c). */
  double surface_energy_contrast = 0.2;
  /** Remove what is smaller than the cells instead of giving up. */
  bool repair_unresolved_shapes = true;

  void add_parameters(dealii::ParameterHandler &prm);
  /** @throws ParameterError for numbers out of range; expressions are checked by AllParameters */
  void check() const;
};

/** How the total concentration, ill-posed as the model stands, is regularised (doc/model.md, "The total
 * concentration"). */
enum class RegularisationModel
{
  compressibility,
  update_smoothing,
  diffusion,
  none
};

/** Section "Membrane/Regularisation of the total concentration". */
struct Regularisation
{
  RegularisationModel model = RegularisationModel::compressibility;
  /** K of the energy density (K/2)(total - 1)^2, which adds (K/2)(1 - total^2) to the tension. */
  double compressibility_modulus = 2.;
  /** delta of r = (I + delta Laplace_s^2)^-1 (-S), the smoothed rate of change of the total concentration. */
  double smoothing_coefficient = 0.05;
  /** D of D Laplace_s(total) on the right side of the transport of the total concentration. */
  double diffusion_coefficient = 1e-3;

  void add_parameters(dealii::ParameterHandler &prm);
  void check() const;
};

/** How a quantity goes from one phase to the other with the composition. */
enum class Interpolation
{
  linear,
  smooth_step
};

/** Section "Membrane/Bending": Helfrich energy (k/2)(curvature - spontaneous curvature)^2 (doc/model.md,
 * "Bending"). */
struct Bending
{
  /** k of the phases with composition 0 and 1. */
  double rigidity_0 = 0.;
  double rigidity_1 = 0.;
  /** Spontaneous curvatures of the phases with composition 0 and 1. */
  double spontaneous_curvature_0 = 0.;
  double spontaneous_curvature_1 = 0.;
  Interpolation interpolation = Interpolation::smooth_step;
  /** C of the numerical rigidity C |sigma| h^2 under negative tension. */
  double grid_scale_rigidity = 1.;

  /** Does the membrane resist bending at all? */
  bool is_active() const { return rigidity_0 > 0. || rigidity_1 > 0.; }

  void add_parameters(dealii::ParameterHandler &prm);
  void check() const;
};

/** How the arclength (2D) or the area (3D) of the membrane is held. */
enum class ArclengthModel
{
  none,
  penalty,
  multiplier
};

/** Section "Membrane/Arclength constraint". */
struct ArclengthConstraint
{
  ArclengthModel model = ArclengthModel::none;
  /** Lambda: adds Lambda (L - L_0) to the tension. */
  double penalty = 100.;
  /** L_0; 0 stands for the initial arclength. */
  double reference_arclength = 0.;

  void add_parameters(dealii::ParameterHandler &prm);
  void check() const;
};
} // namespace Gemmule::Parameters
