// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace Gemmule
{
/** What the user asked for on the command line; see help() for the meaning of the options. */
struct CommandLine
{
  /** Path of the parameter file; empty only with #print_parameters or #information. */
  std::string case_file;
  /** "Section/Key=value", from --set and --output. */
  std::vector<std::string> overrides;
  bool resume = false;
  bool check = false;
  bool print_parameters = false;
  /** Answer to --help or --version; if it is not empty, it is printed and nothing else is done. */
  std::string information;
  /** The command as it was given, for the log; arguments with blanks are quoted. */
  std::string invocation;

  /** @throws UserError for unknown options, missing values, no or more than one parameter file */
  static CommandLine parse(int argc, const char *const *argv);
};

/** Version of the program, revision of its source and versions of the libraries it was built with. */
std::string version_text();
} // namespace Gemmule
