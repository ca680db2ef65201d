// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/model/energy_registry.h>
#include <gemmule/model/membrane_model.h>

#include <cstdio>

namespace Gemmule
{
MembraneModel::MembraneModel(const Parameters::Membrane &membrane,
                             const Parameters::Regularisation &regularisation,
                             const Parameters::Bending &bending)
    : MembraneModel(EnergyRegistry<DoubleWell>::instance().create(membrane.double_well, membrane),
                    EnergyRegistry<SurfaceEnergy>::instance().create(membrane.surface_energy, membrane),
                    membrane, regularisation, bending)
{
}

MembraneModel::MembraneModel(std::unique_ptr<DoubleWell> double_well,
                             std::unique_ptr<SurfaceEnergy> surface_energy,
                             const Parameters::Membrane &membrane,
                             const Parameters::Regularisation &regularisation,
                             const Parameters::Bending &bending)
    : double_well(std::move(double_well)), surface_energy(std::move(surface_energy)),
      peclet(membrane.peclet_number), cahn(membrane.cahn_number), mach(membrane.mach_number),
      choice(regularisation), bending_model(bending)
{
}

MembraneModel::ChemicalPotential MembraneModel::local_chemical_potential(const double f,
                                                                         const double fbar) const
{
  const auto g = double_well->evaluate(f, fbar);
  const auto gamma = surface_energy->evaluate(f, fbar);
  return {g.f + mach * gamma.f, g.ff + mach * gamma.ff};
}

MembraneModel::ChemicalPotential MembraneModel::local_chemical_potential(const double f, const double fbar,
                                                                         const double curvature) const
{
  auto potential = local_chemical_potential(f, fbar);
  const auto bending = bending_model.evaluate(curvature, f / fbar);
  potential.value += mach * bending.by_composition / fbar;
  potential.by_f += mach * bending.by_composition_twice / (fbar * fbar);
  return potential;
}

double MembraneModel::tension(const double f, const double fbar, const double chemical_potential,
                              const double squared_surface_gradient_f) const
{
  const auto g = double_well->evaluate(f, fbar);
  const auto gamma = surface_energy->evaluate(f, fbar);
  const double curvature_of_f = g.f + mach * gamma.f - chemical_potential; // C^2 Laplace_s f
  double sigma = (g.value - f * g.f - fbar * g.fbar - 0.5 * cahn * cahn * squared_surface_gradient_f +
                  f * curvature_of_f) /
                     mach +
                 gamma.value - f * gamma.f - fbar * gamma.fbar;
  if (is_compressible())
    sigma += 0.5 * choice.compressibility_modulus * (1. - fbar * fbar);
  return sigma;
}

double MembraneModel::tension(const double f, const double fbar, const double chemical_potential,
                              const double squared_surface_gradient_f, const double curvature) const
{
  return tension(f, fbar, chemical_potential, squared_surface_gradient_f) +
         f / fbar * bending_model.evaluate(curvature, f / fbar).by_composition;
}

double MembraneModel::dilatational_modulus(const double fbar) const
{
  return is_compressible() ? choice.compressibility_modulus * fbar * fbar : 0.;
}

double MembraneModel::surface_energy_density(const double f, const double fbar) const
{
  double energy = surface_energy->evaluate(f, fbar).value;
  if (is_compressible())
    energy += 0.5 * choice.compressibility_modulus * (fbar - 1.) * (fbar - 1.);
  return energy;
}

double MembraneModel::phase_energy_density(const double f, const double fbar,
                                           const double squared_surface_gradient_f) const
{
  return (double_well->evaluate(f, fbar).value + 0.5 * cahn * cahn * squared_surface_gradient_f) / mach;
}

double MembraneModel::stability(const double composition) const
{
  const double q = double_well->evaluate(composition, 1.).fbar_fbar / mach +
                   surface_energy->evaluate(composition, 1.).fbar_fbar;
  return is_compressible() ? q + choice.compressibility_modulus : q;
}

MembraneModel::LeastStable MembraneModel::least_stable_composition() const
{
  // Energies are arbitrary, so every local minimum counts: a fine scan, of which only the third digit is
  // shown.
  constexpr unsigned int n = 2000;
  LeastStable least{0.5, stability(0.5)};
  for (unsigned int i = 1; i < n; ++i)
  {
    const double c = static_cast<double>(i) / n;
    const double q = stability(c);
    if (q < least.q)
      least = {c, q};
  }
  return least;
}

std::optional<std::string> MembraneModel::ill_posedness_warning() const
{
  // Diffusion and smoothing dominate at short waves whatever the energies are.
  if (choice.model == Parameters::RegularisationModel::diffusion ||
      choice.model == Parameters::RegularisationModel::update_smoothing)
    return {};
  const auto least = least_stable_composition();
  if (least.q >= 0.)
    return {};

  char text[400];
  const char *remedy =
      is_compressible() ? "raise the compressibility modulus"
                        : "choose a regularisation of the total concentration, for example compressibility";
  std::snprintf(text, sizeof(text),
                "The total concentration is ill-posed: short waves grow at the rate %.3g k/Ca (k: wave "
                "number) where the "
                "composition is %.2f (q = %.3f), so that no mesh converges; %s.",
                -0.25 * least.q, least.composition, least.q, remedy);
  return std::string(text);
}
} // namespace Gemmule
