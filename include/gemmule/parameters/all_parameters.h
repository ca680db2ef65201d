// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/base/exceptions.h>
#include <gemmule/parameters/checkpoint.h>
#include <gemmule/parameters/discretisation.h>
#include <gemmule/parameters/domain.h>
#include <gemmule/parameters/fluid.h>
#include <gemmule/parameters/membrane.h>
#include <gemmule/parameters/mesh.h>
#include <gemmule/parameters/output.h>
#include <gemmule/parameters/time_stepping.h>

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace Gemmule::Parameters
{
/**
 * All parameters of a simulation. A default-constructed object is a complete, valid case in 2D; tests change
 * members, the program calls parse().
 */
struct AllParameters
{
  /** Space dimension, 2 or 3. */
  unsigned int dimension = 2;
  /** Simulated time at which the run ends. */
  double end_time = 2.;
  std::string output_directory = "results";

  Domain domain;
  Fluid fluid;
  Membrane membrane;
  Regularisation regularisation;
  Bending bending;
  ArclengthConstraint arclength;
  Mesh mesh;
  Flow flow;
  Surface surface;
  TimeStepping time_stepping;
  Output output;
  Checkpoint checkpoint;

  /** Name of the file that parse() or parse_text() has read; empty without one. */
  std::string parameter_file;
  /** Where each parameter that parse() has found was set, by full name: "case.prm:12" or "command line". */
  std::map<std::string, std::string> places;

  /** Declares every parameter, with the present values as defaults. */
  void add_parameters(dealii::ParameterHandler &prm);

  /**
   * Checks every section, the relations between them, and that all expressions can be evaluated.
   * @throws ParameterError about the first thing that is wrong
   */
  void check() const;

  /**
   * Reads a parameter file and then overrides of the form "Section/Subsection/Key=value", and checks the
   * result. What is not given keeps its present value; corners and boundary velocity that are not given
   * adapt to the dimension.
   *
   * @param file path of the parameter file; empty: no file
   * @throws UserError with file and line (or "command line") in its message
   */
  void parse(const std::string &file, const std::vector<std::string> &overrides = {});

  /**
   * The same for a file that has been read already, as in parallel, where one process reads for all.
   *
   * @param file name of the file, for messages
   * @param text what read_parameter_file() has returned
   * @throws UserError
   */
  void parse_text(const std::string &file, const std::string &text,
                  const std::vector<std::string> &overrides = {});

  /** The error with the place where its parameter was set, for the user. */
  UserError located(const ParameterError &error) const;

  /** Writes every parameter, with description and default, in the syntax that parse() reads. */
  void print(std::ostream &out) const;

  /** The value of every parameter as text, by its full name ("Section/Subsection/Key"). */
  std::map<std::string, std::string> values() const;
};
} // namespace Gemmule::Parameters

namespace Gemmule
{
using Parameters::AllParameters;
}
