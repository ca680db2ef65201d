// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/application/command_line.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/output/provenance.h>
#include <gemmule/parameters/characters.h>
#include <gemmule/parameters/expression_names.h>
#include <gemmule/parameters/source_line.h>
#include <gemmule/parameters/suggestion.h>
#include <gemmule/parameters/text.h>
#include <gemmule/version.h>

#include <CLI/CLI.hpp>
#include <sstream>

namespace Gemmule
{
namespace
{
  const std::string description =
      "Gemmule simulates vesicles in viscous fluids: closed membranes that carry two surface phases and move "
      "with the "
      "Stokes flow that their own tension drives, on adaptive meshes that the membranes cut.\n";

  const std::string footer = R"(Examples:
  gemmule --print-parameters > my_case.prm      a parameter file to start from, with all descriptions
  gemmule my_case.prm --check                   is the file all right? (takes a second)
  gemmule my_case.prm                           compute; results go to the directory that the file names
  gemmule my_case.prm --output trial --set "Fluid/Viscosity ratio=10" --set "End time=0.5"
  mpirun -n 4 gemmule my_case.prm               the same on four processes
  gemmule my_case.prm --resume                  continue after an interruption

Exit codes:
  0  finished
  1  something is wrong with the command or the parameters; the message says what
  2  the simulation failed (its last state is saved), or the disk is full (the last checkpoint stays)
  3  stopped by a signal or its time limit; its state was saved, --resume continues it)";

  std::string quoted(const std::string &argument)
  {
    if (!argument.empty() && argument.find_first_of(" \t\"'$;&|<>()*") == std::string::npos)
      return argument;
    std::string result = "'";
    for (const char c : argument)
      result += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return result + "'";
  }

  const std::string see_help = " 'gemmule --help' shows the options.";

  /** Dashes of word processors and web pages begin no option. */
  void refuse_dashes(const std::string &argument)
  {
    const auto character = Parameters::find_foreign_character(argument);
    if (character && character->column < 3 && character->remedy == "Write '-'.")
      throw UserError("the argument " + Parameters::in_quotes(argument) + " has " + character->name +
                      ". Options begin with two hyphens: '--'." + see_help);
  }

  /** Nor do their quotation marks and blanks keep the words of an argument together. */
  void refuse_typography(const std::string &argument)
  {
    refuse_dashes(argument);
    const auto character = Parameters::find_foreign_character(argument);
    if (!character)
      return;
    const bool is_quote = character->name.find("quotation mark") != std::string::npos;
    if (is_quote || Parameters::find_invisible_character(argument))
      throw UserError(
          "the argument " + Parameters::in_quotes(argument) + " has " + character->name + ". " +
          (is_quote ? "Write the plain quotation marks of the keyboard: \"." : character->remedy) + see_help);
  }

  /** Complains about arguments that the options did not consume. */
  void check_remaining(const std::vector<std::string> &remaining, const std::vector<std::string> &options,
                       const std::string &case_file)
  {
    refuse_dashes(case_file);
    for (const std::string &argument : remaining)
      refuse_typography(argument);
    for (const std::string &argument : remaining)
      if (argument.size() > 1 && argument[0] == '-')
      {
        const std::string similar = Parameters::nearest(argument.substr(0, argument.find('=')), options);
        throw UserError("unknown option " + Parameters::in_quotes(argument) + "." +
                        (similar.empty() ? "" : " Did you mean '" + similar + "'?") + see_help);
      }
    if (!remaining.empty())
      throw UserError("there is more than one parameter file: " + Parameters::in_quotes(case_file) + " and " +
                      Parameters::in_quotes(remaining.front()) +
                      ". Give one; put values with blanks in quotation marks." + see_help);
  }
} // namespace

std::string version_text()
{
  return "Gemmule " + program_version() + "\n" + library_versions() + "\n";
}

CommandLine CommandLine::parse(const int argc, const char *const *argv)
{
  CommandLine result;
  for (int i = 0; i < argc; ++i)
    result.invocation += (i == 0 ? "" : " ") + quoted(argv[i]);

  CLI::App app(description, "gemmule");
  app.allow_extras();
  app.footer(footer);
  app.get_formatter()->column_width(28);
  bool version = false, help_expressions = false;
  std::string directory;
  std::vector<std::string> settings;
  app.add_option("CASE.prm", result.case_file, "Parameter file of the case")->type_name("");
  app.add_option(
         "--set", settings,
         "Replace one parameter of the file, for example --set \"Fluid/Capillary number=0.5\"; may be "
         "repeated")
      ->type_name("\"SECTION/NAME=VALUE\"")
      ->allow_extra_args(false);
  app.add_option("--output", directory, "Directory for the results, instead of the one that the file names")
      ->type_name("DIR");
  app.add_flag("--resume", result.resume, "Continue from the last good checkpoint in the output directory");
  app.add_flag(
      "--check", result.check,
      "Check the parameters, the initial mesh and membrane and the first flow, write nothing, then exit");
  app.add_flag(
      "--print-parameters", result.print_parameters,
      "Print every parameter with description and value as a parameter file, then exit; without CASE.prm: "
      "the defaults");
  app.add_flag("--help-expressions", help_expressions,
               "Print the functions, operators and constants that expressions may use, then exit");
  app.add_flag("--version", version, "Print the versions of Gemmule and of its libraries, then exit");

  try
  {
    app.parse(argc, const_cast<char **>(argv));
  }
  catch (const CLI::CallForHelp &)
  {
    result.information = app.help();
    return result;
  }
  catch (const CLI::ArgumentMismatch &error)
  {
    const std::string text = error.what();
    throw UserError("the option " + text.substr(0, text.find(':')) + " lacks its value." + see_help);
  }
  catch (const CLI::ParseError &error)
  {
    throw UserError("the command line cannot be understood: " + Parameters::in_quotes(error.what()) + "." +
                    see_help);
  }

  std::vector<std::string> options;
  for (const CLI::Option *option : app.get_options())
    for (const std::string &name : option->get_lnames())
      options.push_back("--" + name);
  check_remaining(app.remaining(), options, result.case_file);

  if (help_expressions)
    result.information = Parameters::expression_help();
  else if (version)
    result.information = version_text();
  else if (result.case_file.empty() && !result.print_parameters)
    throw UserError("no parameter file is given. Usage: gemmule CASE.prm [options]." + see_help);

  if (result.check && result.resume)
    throw UserError("--check looks at a new run only: leave out --resume, or --check." + see_help);
  if (app.count("--output") > 0 && directory.empty())
    throw UserError("--output needs the name of a directory." + see_help);
  if (app.count("--output") > 0)
    Parameters::refuse_invisible_characters(directory, "command line");
  result.overrides = settings;
  if (!directory.empty())
    result.overrides.push_back("Output directory=" + directory);
  return result;
}
} // namespace Gemmule
