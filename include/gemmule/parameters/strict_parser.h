// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/parameters/schema.h>
#include <gemmule/parameters/source_line.h>

#include <map>
#include <string>
#include <vector>

namespace Gemmule::Parameters
{
/**
 * Reads parameter files in deal.II's syntax (`subsection NAME ... end`, `set KEY = VALUE`, comments after #,
 * a backslash at the end of a line continues it) into a ParameterHandler, and accepts nothing that is
 * doubtful: unknown names, malformed lines, values that are not allowed and parameters given twice each lead
 * to one message with file, line, section, reason and the nearest valid name.
 */
class StrictParser
{
public:
  /** @param prm with all parameters declared; it has to live as long as the parser */
  explicit StrictParser(dealii::ParameterHandler &prm);

  /**
   * @param file name of the file, for messages
   * @param text what it holds
   * @throws UserError
   */
  void parse_text(const std::string &file, const std::string &text);

  /**
   * Sets one parameter from "Section/Subsection/Key=value", as given on the command line. It replaces what
   * the file says.
   * @throws UserError
   */
  void parse_override(const std::string &assignment);

  /** Where the parameters were set, by full name: "case.prm:12" or "command line". */
  std::map<std::string, std::string> places() const;

private:
  struct OpenSection
  {
    std::string path;
    std::string place;
  };

  void parse_line(const SourceLine &source);
  void enter(const std::string &name, const SourceLine &source);
  /** @param equals where the '=' stands in the line; the value is behind it */
  void assign(const std::string &section, const std::string &key, const SourceLine &source,
              std::string::size_type equals, std::map<std::string, std::string> &already_set);
  [[noreturn]] void unknown_key(const std::string &section, const std::string &key,
                                const std::string &place) const;
  [[noreturn]] void unknown_section(const std::string &section, const std::string &name,
                                    const std::string &place) const;

  dealii::ParameterHandler &prm;
  const Schema schema;
  std::vector<OpenSection> open_sections;
  /** Full name of each parameter that was set, and where. */
  std::map<std::string, std::string> set_in_file, set_on_command_line;
};
} // namespace Gemmule::Parameters
