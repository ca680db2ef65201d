// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/model/bending_model.h>
#include <gemmule/model/energy_density.h>
#include <gemmule/parameters/membrane.h>

#include <memory>
#include <optional>
#include <string>

namespace Gemmule
{
/**
 * The membrane's constitutive law: what its two energies and dimensionless numbers say about chemical
 * potential, tension and energy at one point (doc/model.md, "Membrane"). Everything is dimensionless.
 */
class MembraneModel
{
public:
  /** @throws UserError if a parameter names an unknown energy */
  MembraneModel(const Parameters::Membrane &membrane, const Parameters::Regularisation &regularisation,
                const Parameters::Bending &bending = {});

  /** With energies of one's own. */
  MembraneModel(std::unique_ptr<DoubleWell> double_well, std::unique_ptr<SurfaceEnergy> surface_energy,
                const Parameters::Membrane &membrane, const Parameters::Regularisation &regularisation,
                const Parameters::Bending &bending = {});

  double peclet_number() const { return peclet; }
  double cahn_number() const { return cahn; }
  double mach_number() const { return mach; }
  const Parameters::Regularisation &regularisation() const { return choice; }
  const BendingModel &bending() const { return bending_model; }

  /** Part of the chemical potential that needs no derivative of f along the membrane, and its derivative. */
  struct ChemicalPotential
  {
    double value; ///< g_f + M gamma_f (+ M w_f)
    double by_f;  ///< g_ff + M gamma_ff (+ M w_ff)
  };
  ChemicalPotential local_chemical_potential(double f, double fbar) const;

  /** The same with the part M w_f = M w_c / fbar of the bending energy w(curvature, c), c = f / fbar. */
  ChemicalPotential local_chemical_potential(double f, double fbar, double curvature) const;

  /**
   * Tension without the arclength constraint,
   *
   *   sigma = (1/M) [g - f g_f - fbar g_fbar - C^2/2 |grad_s f|^2 + f (g_f + M gamma_f - mu)] + tau (+
   * (K/2)(1 - fbar^2)), tau = gamma - f gamma_f - fbar gamma_fbar,
   *
   * where the equation of the chemical potential has replaced C^2 Laplace_s f by g_f + M gamma_f - mu, so
   * that no second derivative occurs. The last term belongs to the compressibility regularisation.
   */
  double tension(double f, double fbar, double chemical_potential, double squared_surface_gradient_f) const;

  /**
   * The same for a membrane with bending energy w(curvature, f / fbar): C^2 Laplace_s f is then
   * g_f + M gamma_f + M w_f - mu, which adds f w_f. (w itself, and its part of the tension, belong to the
   * bending force: f w_f + fbar w_fbar = 0.)
   */
  double tension(double f, double fbar, double chemical_potential, double squared_surface_gradient_f,
                 double curvature) const;

  /**
   * E = -d sigma / d log(length) of the regularisation, for a stretch that keeps the composition: K fbar^2
   * with `compressibility`, otherwise 0. The default energies depend on the composition alone and add
   * nothing.
   */
  double dilatational_modulus(double fbar) const;

  /** gamma, plus (K/2)(fbar - 1)^2 with the compressibility regularisation. */
  double surface_energy_density(double f, double fbar) const;

  /** (1/M)(g + C^2/2 |grad_s f|^2). */
  double phase_energy_density(double f, double fbar, double squared_surface_gradient_f) const;

  /**
   * q(c) at fbar = 1: short waves of fbar with wave number k grow at the rate -(k / 4 Ca) q.
   *
   * Short waves of f follow those of fbar so fast that mu stays smooth; then the response of the tension to
   * fbar is d sigma / d fbar = -q / fbar with q = fbar^2 (g_fbar_fbar / M + gamma_fbar_fbar) (+ K fbar^2):
   * the membrane is well-posed where its energy density is convex in fbar. For the default energies q is c^2
   * (3 - 12 c + 10 c^2) / (2 M) + (x^2 c^2 - 2 x c) exp(-x c).
   */
  double stability(double composition) const;

  /** Smallest q(c) over 0 < c < 1, and where it is. */
  struct LeastStable
  {
    double composition;
    double q;
  };
  LeastStable least_stable_composition() const;

  /**
   * Says in one line that the total concentration is ill-posed with these energies and this regularisation
   * (doc/model.md, "Where the model is ill-posed"); nothing if it is well-posed.
   */
  std::optional<std::string> ill_posedness_warning() const;

private:
  bool is_compressible() const { return choice.model == Parameters::RegularisationModel::compressibility; }

  std::unique_ptr<DoubleWell> double_well;
  std::unique_ptr<SurfaceEnergy> surface_energy;
  double peclet, cahn, mach;
  Parameters::Regularisation choice;
  BendingModel bending_model;
};
} // namespace Gemmule
