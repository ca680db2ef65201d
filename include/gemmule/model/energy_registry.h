// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace Gemmule
{
class DoubleWell;
class SurfaceEnergy;
namespace Parameters
{
  struct Membrane;
}

/**
 * The known energies of one kind by name. A new energy is a class and one line in energy_registry.cc
 * (doc/extending.md); a program that links the library can add its own with add() before it makes the model.
 */
template <typename Energy>
class EnergyRegistry
{
public:
  using Factory = std::function<std::unique_ptr<Energy>(const Parameters::Membrane &)>;

  /** The registry with the energies that come with the library already in it. */
  static EnergyRegistry &instance();

  /** Adds an energy, or replaces the one of the same name. */
  void add(const std::string &name, Factory factory) { factories[name] = std::move(factory); }

  /** @throws UserError listing the known names if @p name is none of them */
  std::unique_ptr<Energy> create(const std::string &name, const Parameters::Membrane &parameters) const;

  std::vector<std::string> names() const;

private:
  EnergyRegistry() = default;
  std::map<std::string, Factory> factories;
};

extern template class EnergyRegistry<DoubleWell>;
extern template class EnergyRegistry<SurfaceEnergy>;
} // namespace Gemmule
