// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/model/energy_density.h>
#include <gemmule/model/energy_registry.h>
#include <gemmule/model/exponential_surface_energy.h>
#include <gemmule/model/quartic_double_well.h>
#include <gemmule/parameters/membrane.h>
#include <gemmule/parameters/text.h>

namespace Gemmule
{
namespace
{
  // Registered here by name, not by static objects in the energies' own files: a linker drops the object
  // files of a static library that nothing refers to, and the registration with them.
  void register_own(EnergyRegistry<DoubleWell> &registry)
  {
    registry.add("quartic",
                 [](const Parameters::Membrane &) { return std::make_unique<QuarticDoubleWell>(); });
  }

  void register_own(EnergyRegistry<SurfaceEnergy> &registry)
  {
    registry.add("exponential", [](const Parameters::Membrane &parameters)
                 { return std::make_unique<ExponentialSurfaceEnergy>(parameters.surface_energy_contrast); });
  }

  const char *parameter_name(const EnergyRegistry<DoubleWell> &)
  {
    return "Membrane/Double well";
  }
  const char *parameter_name(const EnergyRegistry<SurfaceEnergy> &)
  {
    return "Membrane/Surface energy";
  }
} // namespace

template <typename Energy>
EnergyRegistry<Energy> &EnergyRegistry<Energy>::instance()
{
  static EnergyRegistry registry = []
  {
    EnergyRegistry r;
    register_own(r);
    return r;
  }();
  return registry;
}

template <typename Energy>
std::unique_ptr<Energy> EnergyRegistry<Energy>::create(const std::string &name,
                                                       const Parameters::Membrane &parameters) const
{
  const auto factory = factories.find(name);
  if (factory == factories.end())
  {
    std::string known;
    for (const auto &[key, unused] : factories)
      known += (known.empty() ? "'" : ", '") + key + "'";
    throw ParameterError(parameter_name(*this), "there is no energy of the name " +
                                                    Parameters::in_quotes(name) +
                                                    ". Choose one of: " + known + ".");
  }
  return factory->second(parameters);
}

template <typename Energy>
std::vector<std::string> EnergyRegistry<Energy>::names() const
{
  std::vector<std::string> result;
  for (const auto &[name, unused] : factories)
    result.push_back(name);
  return result;
}

template class EnergyRegistry<DoubleWell>;
template class EnergyRegistry<SurfaceEnergy>;
} // namespace Gemmule
