// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace Gemmule
{
/**
 * Something that the user can correct: a parameter, the command line, a file. The message is printed as it
 * is, so it names the place and the remedy. The program ends with exit code 1.
 */
class UserError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/**
 * A computation that cannot go on (no convergence, time step too small, membrane at the wall). The message
 * says what happened and what usually helps. The program ends with exit code 2.
 */
class SimulationError : public std::runtime_error
{
public:
  using std::runtime_error::runtime_error;
};

/**
 * A time step that cannot be computed with the size that it has: the solution breaks down, and no parameter
 * or place of the membrane is to blame. A shorter step, or a finer mesh, may do.
 */
class StepBreakdown : public SimulationError
{
public:
  using SimulationError::SimulationError;
};

/**
 * A file that the system does not let the program write or read. The message names the file, says why and
 * what removes the cause; whoever knows whether there is a checkpoint adds how to go on then.
 */
class DiskError : public SimulationError
{
public:
  using SimulationError::SimulationError;
};

/**
 * A parameter whose value is not acceptable. It knows which one, so that the parser can add the file and
 * the line that set it.
 */
class ParameterError : public UserError
{
public:
  /**
   * @param parameter full name, sections separated by "/", for example "Fluid/Capillary number"
   * @param complaint what is wrong and what to do; the message is "<parameter>: <complaint>"
   */
  ParameterError(const std::string &parameter, const std::string &complaint)
      : UserError(parameter + ": " + complaint), parameter(parameter), complaint(complaint)
  {
  }

  /** Full name of the parameter. */
  const std::string parameter;
  /** The message without the name. */
  const std::string complaint;
};
} // namespace Gemmule
