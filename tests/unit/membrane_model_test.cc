// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/model/energy_registry.h>
#include <gemmule/model/membrane_model.h>

#include <cmath>
#include <gtest/gtest.h>

using namespace Gemmule;

namespace
{
const double points[][2] = {{0.1, 0.8}, {0.5, 1.}, {0.7, 1.3}, {-0.05, 0.9}, {1.2, 1.1}};

/** Compares all derivatives of an energy with central differences. */
template <typename Energy>
void expect_derivatives_match_differences(const Energy &energy)
{
  const double s = 1e-5;
  for (const auto &[f, t] : points)
  {
    const auto e = energy.evaluate(f, t);
    const auto east = energy.evaluate(f + s, t), west = energy.evaluate(f - s, t);
    const auto north = energy.evaluate(f, t + s), south = energy.evaluate(f, t - s);
    EXPECT_NEAR(e.f, (east.value - west.value) / (2 * s), 2e-8);
    EXPECT_NEAR(e.fbar, (north.value - south.value) / (2 * s), 2e-8);
    EXPECT_NEAR(e.ff, (east.f - west.f) / (2 * s), 2e-8);
    EXPECT_NEAR(e.f_fbar, (east.fbar - west.fbar) / (2 * s), 2e-8);
    EXPECT_NEAR(e.f_fbar, (north.f - south.f) / (2 * s), 2e-8);
    EXPECT_NEAR(e.fbar_fbar, (north.fbar - south.fbar) / (2 * s), 2e-8);
  }
}

MembraneModel make_model(const Parameters::RegularisationModel choice, const double modulus = 2.)
{
  Parameters::Membrane membrane;
  Parameters::Regularisation regularisation;
  regularisation.model = choice;
  regularisation.compressibility_modulus = modulus;
  return MembraneModel(membrane, regularisation);
}
} // namespace

TEST(MembraneEnergy, QuarticDoubleWellIsTheDesignsFormula)
{
  const auto well = EnergyRegistry<DoubleWell>::instance().create("quartic", {});
  const double f = 0.3, t = 1.2, c = f / t;
  EXPECT_NEAR(well->evaluate(f, t).value, c * c * (1 - c) * (1 - c) / 4, 1e-15);
  EXPECT_NEAR(well->evaluate(f, t).f, c * (1 - c) * (1 - 2 * c) / (2 * t), 1e-15);
  expect_derivatives_match_differences(*well);
}

TEST(MembraneEnergy, ExponentialSurfaceEnergyIsTheDesignsFormula)
{
  Parameters::Membrane membrane;
  membrane.surface_energy_contrast = 0.7;
  const auto energy = EnergyRegistry<SurfaceEnergy>::instance().create("exponential", membrane);
  EXPECT_NEAR(energy->evaluate(0.3, 1.2).value, std::exp(-0.7 * 0.25), 1e-15);
  expect_derivatives_match_differences(*energy);
}

TEST(MembraneEnergy, UnknownNameListsTheKnownOnes)
{
  try
  {
    EnergyRegistry<SurfaceEnergy>::instance().create("exponental", {});
    FAIL() << "expected UserError";
  }
  catch (const UserError &error)
  {
    const std::string message = error.what();
    EXPECT_NE(message.find("'exponental'"), std::string::npos) << message;
    EXPECT_NE(message.find("'exponential'"), std::string::npos) << message;
  }
}

TEST(MembraneEnergy, OwnEnergyCanBeRegistered)
{
  struct Linear : SurfaceEnergy
  {
    EnergyDerivatives evaluate(double f, double) const override { return {1. - f, -1., 0., 0., 0., 0.}; }
  };
  EnergyRegistry<SurfaceEnergy>::instance().add("linear", [](const Parameters::Membrane &)
                                                { return std::make_unique<Linear>(); });
  Parameters::Membrane membrane;
  membrane.surface_energy = "linear";
  const MembraneModel model(membrane, {});
  EXPECT_NEAR(model.surface_energy_density(0.25, 1.), 0.75, 1e-15);
}

TEST(MembraneModel, ChemicalPotentialIsTheDerivativeOfTheEnergies)
{
  const auto model = make_model(Parameters::RegularisationModel::none);
  const double s = 1e-5;
  for (const auto &[f, t] : points)
  {
    const auto energy = [&](double x)
    { return model.surface_energy_density(x, t) + model.phase_energy_density(x, t, 0.); };
    EXPECT_NEAR(model.local_chemical_potential(f, t).value,
                model.mach_number() * (energy(f + s) - energy(f - s)) / (2 * s), 2e-8);
    EXPECT_NEAR(
        model.local_chemical_potential(f, t).by_f,
        (model.local_chemical_potential(f + s, t).value - model.local_chemical_potential(f - s, t).value) /
            (2 * s),
        1e-8);
  }
}

// A membrane that is stretched by a factor dilutes f and fbar: the tension of a uniform state is the
// derivative of its energy with respect to area. This holds for the compressibility term as well.
TEST(MembraneModel, TensionOfAUniformStateIsTheDerivativeOfItsEnergyByArea)
{
  for (const auto choice :
       {Parameters::RegularisationModel::none, Parameters::RegularisationModel::compressibility})
  {
    const auto model = make_model(choice);
    const double s = 1e-5;
    for (const auto &[f, t] : points)
    {
      const double mu = model.local_chemical_potential(f, t).value;
      const auto energy = [&, f = f, t = t](double a) {
        return a *
               (model.surface_energy_density(f / a, t / a) + model.phase_energy_density(f / a, t / a, 0.));
      };
      EXPECT_NEAR(model.tension(f, t, mu, 0.), (energy(1. + s) - energy(1. - s)) / (2. * s), 1e-8);
    }
  }
}

TEST(MembraneModel, GradientLowersTheTensionByThePhaseEnergy)
{
  Parameters::Membrane membrane;
  membrane.mach_number = 0.5;
  membrane.cahn_number = 0.1;
  const MembraneModel model(membrane, {});
  EXPECT_NEAR(model.tension(0.4, 1.1, 0.3, 2.) - model.tension(0.4, 1.1, 0.3, 0.), -0.01 / 2. * 2. / 0.5,
              1e-14);
  EXPECT_NEAR(model.phase_energy_density(0.4, 1.1, 2.) - model.phase_energy_density(0.4, 1.1, 0.),
              0.01 / 2. * 2. / 0.5, 1e-14);
}

TEST(IllPosedness, CriterionIsTheDesignsFormulaForTheDefaultEnergies)
{
  const auto model = make_model(Parameters::RegularisationModel::none);
  const double x = 0.2;
  for (const double c : {0.1, 0.3, 0.5, 0.71, 0.9, 1.})
    EXPECT_NEAR(model.stability(c),
                c * c * (3. - 12. * c + 10. * c * c) / 2. + (x * x * c * c - 2. * x * c) * std::exp(-x * c),
                1e-14);
  const auto least = model.least_stable_composition();
  EXPECT_NEAR(least.q, -0.350, 5e-4);
  EXPECT_NEAR(least.composition, 0.71, 5e-3);
}

// The criterion is a statement about the tension: vary fbar and let f follow such that mu stays as it is (the
// gradient term then carries the change of the local chemical potential).
TEST(IllPosedness, CriterionIsTheTensionsResponse)
{
  const auto model = make_model(Parameters::RegularisationModel::compressibility, 0.3);
  const double s = 1e-5, mu = 0.123;
  for (const double c : {0.2, 0.5, 0.71, 0.9})
    EXPECT_NEAR(model.stability(c),
                -(model.tension(c, 1. + s, mu, 0.) - model.tension(c, 1. - s, mu, 0.)) / (2. * s), 1e-8);
}

TEST(IllPosedness, WarnsExactlyWhenIllPosed)
{
  using Choice = Parameters::RegularisationModel;
  const auto warning = make_model(Choice::none).ill_posedness_warning();
  ASSERT_TRUE(warning.has_value());
  EXPECT_NE(warning->find("-0.350"), std::string::npos) << *warning;
  EXPECT_EQ(warning->find('\n'), std::string::npos);
  EXPECT_TRUE(make_model(Choice::compressibility, 0.34).ill_posedness_warning().has_value());
  EXPECT_FALSE(make_model(Choice::compressibility, 0.36).ill_posedness_warning().has_value());
  EXPECT_FALSE(make_model(Choice::diffusion).ill_posedness_warning().has_value());
  EXPECT_FALSE(make_model(Choice::update_smoothing).ill_posedness_warning().has_value());
}
