// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

namespace dealii
{
class ParameterHandler;
}

namespace Gemmule::Parameters
{
/** Which sections and parameters a ParameterHandler has, for messages and for copying values. */
class Schema
{
public:
  struct Entry
  {
    std::string value;
    /** The allowed values in words. */
    std::string allowed;
  };

  explicit Schema(const dealii::ParameterHandler &prm);

  /** All parameters by full name, sections separated by "/". */
  const std::map<std::string, Entry> &entries() const { return all_entries; }
  /** Names of the parameters directly in a section ("" is the top level), in alphabetical order. */
  std::vector<std::string> keys(const std::string &section) const;
  /** Names of the sections directly in a section, in alphabetical order. */
  std::vector<std::string> subsections(const std::string &section) const;
  bool has_section(const std::string &section) const;
  /** Sections that directly hold a parameter or a section of this name. */
  std::vector<std::string> holders_of_key(const std::string &key) const;
  std::vector<std::string> holders_of_section(const std::string &name) const;

  /** "section/name", or just the name at the top level. */
  static std::string join(const std::string &section, const std::string &name);
  /** The part before and the part after the last "/". */
  static std::pair<std::string, std::string> split(const std::string &path);

private:
  std::map<std::string, Entry> all_entries;
  std::vector<std::string> all_sections;
};
} // namespace Gemmule::Parameters
