// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace Gemmule::Testing
{
/** Columns of statistics.csv with their entries as text, so that a comparison is exact. */
using TextTable = std::map<std::string, std::vector<std::string>>;

inline TextTable read_text_table(const std::string &path)
{
  std::ifstream file(path);
  TextTable table;
  std::vector<std::string> names;
  std::string line, entry;
  std::getline(file, line);
  for (std::istringstream header(line); std::getline(header, entry, ',');)
    names.push_back(entry);
  while (std::getline(file, line))
  {
    std::istringstream row(line);
    for (const auto &name : names)
    {
      entry.clear();
      std::getline(row, entry, ',');
      table[name].push_back(entry);
    }
  }
  return table;
}
} // namespace Gemmule::Testing
