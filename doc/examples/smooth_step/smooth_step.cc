// SPDX-License-Identifier: LGPL-2.1-or-later
// A surface energy of one's own in a program of one's own, linked with the installed library
// (doc/extending.md):
//   smooth_step CASE.prm
#include <gemmule/application/vesicle_problem.h>
#include <gemmule/model/energy_density.h>
#include <gemmule/model/energy_registry.h>
#include <gemmule/parameters/all_parameters.h>

#include <deal.II/base/mpi.h>

#include <exception>
#include <iostream>
#include <memory>

/** gamma = 1 - x c^2 (3 - 2c): the pure phases c = 0 and c = 1 are stationary points of gamma. */
class SmoothStepSurfaceEnergy : public Gemmule::SurfaceEnergy
{
public:
  explicit SmoothStepSurfaceEnergy(const double contrast) : contrast(contrast) {}

  Gemmule::EnergyDerivatives evaluate(const double f, const double fbar) const override
  {
    const double c = f / fbar;
    return Gemmule::density_of_composition(c, fbar, 1. - contrast * c * c * (3. - 2. * c),
                                           -6. * contrast * c * (1. - c), -6. * contrast * (1. - 2. * c));
  }

private:
  double contrast;
};

int main(int argc, char **argv)
{
  dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  Gemmule::EnergyRegistry<Gemmule::SurfaceEnergy>::instance().add(
      "smooth step", [](const Gemmule::Parameters::Membrane &membrane)
      { return std::make_unique<SmoothStepSurfaceEnergy>(membrane.surface_energy_contrast); });
  try
  {
    Gemmule::AllParameters parameters;
    parameters.parse(argc > 1 ? argv[1] : "", {"Membrane/Surface energy=smooth step"});
    return Gemmule::VesicleProblem<2>(parameters, MPI_COMM_WORLD, argv[0], false).run();
  }
  catch (const std::exception &error) // UserError and SimulationError have a message for the user
  {
    std::cerr << "error: " << error.what() << std::endl;
    return 1;
  }
}
