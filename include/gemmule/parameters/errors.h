#pragma once

#include <stdexcept>
#include <string>

namespace Gemmule
{
/** The user asked for something impossible (parameters, command line, files): exit code 1. */
class UserError : public std::runtime_error
{
public:
  explicit UserError(const std::string &message) : std::runtime_error(message) {}
};

/** The simulation cannot go on (solver, disk, geometry): exit code 2. */
class SimulationError : public std::runtime_error
{
public:
  explicit SimulationError(const std::string &message) : std::runtime_error(message) {}
};
} // namespace Gemmule
