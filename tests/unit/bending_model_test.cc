// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/coupling/grid_scale_rigidity.h>
#include <gemmule/model/membrane_model.h>

#include <cmath>
#include <gtest/gtest.h>

using namespace Gemmule;

namespace
{
Parameters::Bending two_phases(const Parameters::Interpolation interpolation)
{
  Parameters::Bending parameters;
  parameters.rigidity_0 = 0.5;
  parameters.rigidity_1 = 2.;
  parameters.spontaneous_curvature_0 = 1.;
  parameters.spontaneous_curvature_1 = -3.;
  parameters.interpolation = interpolation;
  return parameters;
}
} // namespace

class BendingEnergy : public testing::TestWithParam<Parameters::Interpolation>
{
};

TEST_P(BendingEnergy, HasTheParametersOfThePhases)
{
  const BendingModel model(two_phases(GetParam()));
  // also beyond 0 and 1
  for (const double c : {0., -0.1})
  {
    EXPECT_DOUBLE_EQ(model.evaluate(1., c).rigidity, 0.5);
    EXPECT_DOUBLE_EQ(model.evaluate(1., c).spontaneous_curvature, 1.);
  }
  for (const double c : {1., 1.2})
  {
    EXPECT_DOUBLE_EQ(model.evaluate(1., c).rigidity, 2.);
    EXPECT_DOUBLE_EQ(model.evaluate(1., c).spontaneous_curvature, -3.);
    EXPECT_DOUBLE_EQ(model.evaluate(1., c).energy, 0.5 * 2. * 16.);
  }
  EXPECT_EQ(model.largest_rigidity(), 2.);
}

TEST_P(BendingEnergy, DerivativesMatchDifferences)
{
  const BendingModel model(two_phases(GetParam()));
  const double s = 1e-5;
  for (const double curvature : {-2., 0.5, 4.})
    for (const double c : {-0.2, 0.1, 0.5, 0.8, 1.1})
    {
      const auto local = model.evaluate(curvature, c);
      const auto east = model.evaluate(curvature, c + s), west = model.evaluate(curvature, c - s);
      EXPECT_NEAR(local.by_composition, (east.energy - west.energy) / (2. * s), 1e-7);
      EXPECT_NEAR(local.by_composition_twice, (east.by_composition - west.by_composition) / (2. * s), 1e-7);
      EXPECT_NEAR(local.moment,
                  (model.evaluate(curvature + s, c).energy - model.evaluate(curvature - s, c).energy) /
                      (2. * s),
                  1e-8);
    }
}

INSTANTIATE_TEST_SUITE_P(Interpolations, BendingEnergy,
                         testing::Values(Parameters::Interpolation::linear,
                                         Parameters::Interpolation::smooth_step));

TEST(BendingOfTheMembrane, ChemicalPotentialIsTheDerivativeOfTheWholeEnergy)
{
  Parameters::Membrane membrane;
  membrane.mach_number = 0.7;
  const MembraneModel model(membrane, {}, two_phases(Parameters::Interpolation::smooth_step));
  const double s = 1e-5, curvature = 2.5, t = 1.2;
  for (const double f : {0.2, 0.6, 1.})
  {
    const auto energy = [&](const double x)
    {
      return model.surface_energy_density(x, t) + model.phase_energy_density(x, t, 0.) +
             model.bending().evaluate(curvature, x / t).energy;
    };
    EXPECT_NEAR(model.local_chemical_potential(f, t, curvature).value,
                0.7 * (energy(f + s) - energy(f - s)) / (2. * s), 1e-7);
    EXPECT_NEAR(model.local_chemical_potential(f, t, curvature).by_f,
                (model.local_chemical_potential(f + s, t, curvature).value -
                 model.local_chemical_potential(f - s, t, curvature).value) /
                    (2. * s),
                1e-6);
  }
}

// Where f is uniform the Laplacian that the tension contains vanishes, whatever mu consists of: the bending
// energy, whose force is another functional, leaves no trace in the tension.
TEST(BendingOfTheMembrane, LeavesTheTensionOfAUniformStateAlone)
{
  Parameters::Membrane membrane;
  membrane.mach_number = 0.7;
  const MembraneModel model(membrane, {}, two_phases(Parameters::Interpolation::smooth_step));
  const double f = 0.4, t = 1.1, curvature = 2.5;
  const double without = model.tension(f, t, model.local_chemical_potential(f, t).value, 0.);
  EXPECT_NEAR(model.tension(f, t, model.local_chemical_potential(f, t, curvature).value, 0., curvature),
              without, 1e-13);
  EXPECT_GT(
      std::abs(model.tension(f, t, model.local_chemical_potential(f, t, curvature).value, 0.) - without), 0.1)
      << "the test would not notice the missing term";
}

TEST(GridScaleRigidity, IsWhatAPhaseLacks)
{
  Parameters::Bending parameters;
  parameters.rigidity_0 = 2e-3;
  parameters.rigidity_1 = 1e-3;
  const BendingModel phases(parameters);
  GridScaleRigidity model(phases, 0.5);
  const double h = 0.1, curvature = 3.;
  const auto numerical = [&](const double c) { return model.evaluate(curvature, c).numerical_rigidity; };
  model.resist_negative_tension(0.7, h);
  EXPECT_EQ(numerical(0.), 0.);
  EXPECT_EQ(numerical(1.), 0.);
  model.resist_negative_tension(-0.1, h); // 5e-4 is less than both phases have
  EXPECT_EQ(numerical(0.), 0.);
  EXPECT_EQ(numerical(1.), 0.);
  EXPECT_NEAR(model.largest_rigidity(), 2e-3, 1e-15);
  model.resist_negative_tension(-0.3, h); // 1.5e-3
  EXPECT_EQ(numerical(0.), 0.);
  EXPECT_NEAR(numerical(1.), 5e-4, 1e-15);
  model.resist_negative_tension(-0.6, h); // 3e-3
  EXPECT_NEAR(numerical(0.), 1e-3, 1e-15);
  EXPECT_NEAR(numerical(1.), 2e-3, 1e-15);
  EXPECT_NEAR(model.largest_rigidity(), 3e-3, 1e-15);
  model.resist_negative_tension(0., h);
  EXPECT_EQ(numerical(1.), 0.);
}

TEST(GridScaleRigidity, AddsItsEnergyWithItsDerivative)
{
  Parameters::Bending parameters = two_phases(Parameters::Interpolation::linear);
  const BendingModel bare(parameters);
  GridScaleRigidity model(bare, 1.);
  const double curvature = 1.7, c = 0.4, eps = 1e-5, missing = 0.3;
  model.set(bare.evaluate(curvature, c).rigidity + missing);
  const auto with = model.evaluate(curvature, c), without = bare.evaluate(curvature, c);
  EXPECT_NEAR(with.energy - without.energy, 0.15 * curvature * curvature, 1e-14);
  EXPECT_NEAR(with.numerical_energy, 0.15 * curvature * curvature, 1e-14);
  EXPECT_NEAR(with.moment,
              (model.evaluate(curvature + eps, c).energy - model.evaluate(curvature - eps, c).energy) /
                  (2. * eps),
              1e-8);
  EXPECT_DOUBLE_EQ(with.by_composition, without.by_composition);

  // A membrane without any rigidity of its own has it, too.
  const BendingModel soft{Parameters::Bending()};
  GridScaleRigidity resisting(soft, 1.);
  EXPECT_FALSE(soft.is_active());
  EXPECT_EQ(resisting.evaluate(2., 0.5).moment, 0.);
  resisting.set(0.3);
  EXPECT_NEAR(resisting.evaluate(2., 0.5).moment, 0.6, 1e-15);
  EXPECT_EQ(soft.evaluate(2., 0.5).moment, 0.) << "the law of the phases does not change";
}
