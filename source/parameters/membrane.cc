// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/membrane.h>
#include <gemmule/parameters/section.h>

#include <deal.II/base/parameter_handler.h>

namespace Gemmule::Parameters
{
void Membrane::add_parameters(dealii::ParameterHandler &prm)
{
  Section section(prm, {"Membrane"});
  const std::string expression = "an expression";
  section.add(
      "Level set", level_set,
      "Initial shape: an expression in x, y(, z), negative inside the membrane and positive outside; the "
      "membrane is where it vanishes (dimensionless length or any monotone function of it). It may "
      "describe several closed membranes and has to stay away from the walls.",
      expression);
  section.add(
      "Tension model", tension_model,
      "'phase field': the tension follows from the concentrations of the phases, which are transported and "
      "separate. 'prescribed': the tension is the expression 'Prescribed tension' and no concentration is "
      "computed.",
      {{"phase field", TensionModel::phase_field}, {"prescribed", TensionModel::prescribed}});
  section.add("Prescribed tension", prescribed_tension,
              "Tension sigma as an expression in x, y(, z) and t (dimensionless), used by the tension model "
              "'prescribed'.",
              expression);
  section.add(
      "Initial concentration", initial_concentration,
      "Concentration f of one phase at t = 0, an expression in x, y(, z) (dimensionless; the composition is "
      "c = f / total concentration, between 0 and 1). The default is that of Li, Lowengrub, Voigt (2012).",
      expression);
  section.add(
      "Initial total concentration", initial_total_concentration,
      "Total concentration of both phases at t = 0, an expression in x, y(, z), positive on the membrane "
      "(dimensionless).",
      expression);
  section.add(
      "Peclet number", peclet_number,
      "Pe: advection over surface diffusion (dimensionless); the flux of the phases is -(1/Pe) grad_s mu. "
      "Source: Li, Lowengrub, Voigt (2012).",
      Range::positive());
  section.add(
      "Cahn number", cahn_number,
      "C: thickness of the phase boundaries relative to the reference length (dimensionless). The profile in "
      "equilibrium is (1+tanh(s/(2 sqrt(2) C)))/2; it rises from 10 to 90 % over 6.2 C.",
      Range::positive());
  section.add(
      "Mach number", mach_number,
      "M: surface energy over the energy of the phase boundaries (dimensionless); the phase energy enters "
      "the tension with 1/M. Source: Li, Lowengrub, Voigt (2012).",
      Range::positive());
  section.add("Double well", double_well,
              "Name of the double-well energy g that separates the phases; 'quartic' is g = c^2 (1-c)^2 / 4 "
              "(dimensionless).",
              "the name of a double-well energy");
  section.add("Surface energy", surface_energy,
              "Name of the surface energy gamma, whose differences between the phases move the vesicle; "
              "'exponential' is gamma = exp(-x c) with x the 'Surface energy contrast' (dimensionless).",
              "the name of a surface energy");
  section.add(
      "Surface energy contrast", surface_energy_contrast,
      "The x in gamma = exp(-x c) (dimensionless); 0 makes both phases alike. Source: Li, Lowengrub, Voigt "
      "(2012).",
      Range::any());
  section.add(
      "Repair unresolved shapes", repair_unresolved_shapes,
      "What to do when steps fail and the mesh does not resolve the membrane, which has folds or spikes "
      "within a cell or two sheets in one: true: what is thinner than 1.5 cells (up to 6 where that leaves "
      "shapes that are not resolved) is removed, two sheets so near each other merge, and the run goes on, "
      "with the same enclosed area and masses; false: the run ends.");
}

void Membrane::check() const
{
  Membrane copy(*this);
  dealii::ParameterHandler prm;
  copy.add_parameters(prm);
}

void Regularisation::add_parameters(dealii::ParameterHandler &prm)
{
  Section section(prm, {"Membrane", "Regularisation of the total concentration"});
  section.add("Model", model,
              "The total concentration has no diffusion of its own, and short waves of it can grow without "
              "bound, so that long "
              "computations need one of these. 'compressibility': an elastic energy (K/2)(total-1)^2, "
              "thermodynamically "
              "consistent; the energy keeps decreasing. 'update smoothing': the rate of change of the total "
              "concentration is "
              "smoothed by (I + delta Laplace_s^2)^-1, a fit to published figures that obeys no energy law; "
              "the composition "
              "may leave the interval from 0 to 1. 'diffusion': D Laplace_s of the total concentration; "
              "conserves mass, no "
              "energy law. 'none': the model as published, meaningful for short times only.",
              {{"compressibility", RegularisationModel::compressibility},
               {"update smoothing", RegularisationModel::update_smoothing},
               {"diffusion", RegularisationModel::diffusion},
               {"none", RegularisationModel::none}});
  section.add(
      "Compressibility modulus", compressibility_modulus,
      "K of the model 'compressibility' (dimensionless): adds (K/2)(1 - total^2) to the tension. With the "
      "default energies short waves decay for K > 0.350 / min(total)^2; the larger K, the closer the "
      "membrane is to local inextensibility.",
      Range::non_negative());
  section.add(
      "Smoothing coefficient", smoothing_coefficient,
      "delta of the model 'update smoothing' (length^4, dimensionless). Waves shorter than about "
      "2 pi delta^(1/4) do not change. Values from 0.02 to 0.05 lead to two phase regions and locomotion.",
      Range::non_negative());
  section.add("Diffusion coefficient", diffusion_coefficient,
              "D of the model 'diffusion' (length^2 per time, dimensionless).", Range::non_negative());
}

void Regularisation::check() const
{
  Regularisation copy(*this);
  dealii::ParameterHandler prm;
  copy.add_parameters(prm);
}

void Bending::add_parameters(dealii::ParameterHandler &prm)
{
  Section section(prm, {"Membrane", "Bending"});
  const std::string unit =
      " (dimensionless: energy relative to the reference tension times the reference length squared)";
  section.add(
      "Rigidity at composition 0", rigidity_0,
      "Bending rigidity k of the phase with composition 0 in the Helfrich energy "
      "(k/2)(curvature - spontaneous curvature)^2 per length" +
          unit +
          ". 0: no resistance to bending; negative tension then wrinkles the membrane at the length of "
          "the mesh. With a prescribed tension this value holds everywhere.",
      Range::non_negative());
  section.add("Rigidity at composition 1", rigidity_1,
              "Bending rigidity k of the phase with composition 1" + unit + ".", Range::non_negative());
  section.add("Spontaneous curvature at composition 0", spontaneous_curvature_0,
              "Curvature that the phase with composition 0 prefers (inverse length, dimensionless); positive "
              "on a circle. With a prescribed tension this value holds everywhere.",
              Range::any());
  section.add("Spontaneous curvature at composition 1", spontaneous_curvature_1,
              "Curvature that the phase with composition 1 prefers (inverse length, dimensionless).",
              Range::any());
  section.add("Interpolation", interpolation,
              "How rigidity and spontaneous curvature go from one phase to the other: 'smooth step' with "
              "c^2 (3 - 2 c), whose slope vanishes in both phases, or 'linear' with the composition c; "
              "constant beyond 0 and 1.",
              {{"smooth step", Interpolation::smooth_step}, {"linear", Interpolation::linear}});
  section.add(
      "Grid-scale rigidity", grid_scale_rigidity,
      "C of a numerical rigidity C |sigma| h^2 that a membrane under negative tension sigma gets, as far as "
      "its "
      "own is smaller; h is the edge of the cells of 'Mesh/Membrane level' and sigma the smallest tension. "
      "The wrinkles that grow fastest are then 2 pi sqrt(3 C) cells long, instead of as short as possible "
      "(dimensionless); 0: none, and waves of single cells break the membrane up.",
      Range::non_negative());
}

void Bending::check() const
{
  Bending copy(*this);
  dealii::ParameterHandler prm;
  copy.add_parameters(prm);
}

void ArclengthConstraint::add_parameters(dealii::ParameterHandler &prm)
{
  Section section(prm, {"Membrane", "Arclength constraint"});
  section.add("Model", model,
              "'none': the membrane may stretch. 'penalty': the tension grows by Lambda (L - L_0), the same "
              "everywhere, with L the arclength (the area in 3D). 'multiplier': a tension that is the same "
              "everywhere keeps L = L_0 up to the error of a single step, which the next one removes.",
              {{"none", ArclengthModel::none},
               {"penalty", ArclengthModel::penalty},
               {"multiplier", ArclengthModel::multiplier}});
  section.add(
      "Penalty", penalty,
      "Lambda of the model 'penalty': tension per length (dimensionless). Source: Li, Lowengrub, Voigt "
      "(2012).",
      Range::non_negative());
  section.add("Reference arclength", reference_arclength,
              "L_0 of the models 'penalty' and 'multiplier' (dimensionless length); 0 stands for the initial "
              "arclength.",
              Range::non_negative());
}

void ArclengthConstraint::check() const
{
  ArclengthConstraint copy(*this);
  dealii::ParameterHandler prm;
  copy.add_parameters(prm);
}
} // namespace Gemmule::Parameters
