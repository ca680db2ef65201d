// SPDX-License-Identifier: LGPL-2.1-or-later
// doc/output.md explains all that the program writes.
#include <gemmule/output/interface_output.h>
#include <gemmule/output/provenance.h>
#include <gemmule/output/statistics.h>

#include <set>

#include "support/output_test.h"

using namespace Gemmule;

namespace
{
/** The names in backticks in the first column of the tables under a heading. */
std::set<std::string> explained_under(const std::string &heading)
{
  std::ifstream file(GEMMULE_SOURCE_DIRECTORY "/doc/output.md");
  std::set<std::string> names;
  bool is_in_section = false;
  for (std::string line; std::getline(file, line);)
  {
    if (line.compare(0, 3, "## ") == 0)
      is_in_section = line == "## " + heading;
    if (!is_in_section || line.compare(0, 3, "| `") != 0)
      continue;
    const std::string cell = line.substr(2, line.find(" | ") - 2);
    for (std::size_t begin = cell.find('`'); begin != std::string::npos;)
    {
      const std::size_t end = cell.find('`', begin + 1);
      names.insert(cell.substr(begin + 1, end - begin - 1));
      begin = cell.find('`', end + 1);
    }
  }
  return names;
}
} // namespace

TEST(Documentation, EveryColumnOfTheStatisticsIsExplainedAndNoOther)
{
  const std::vector<std::string> columns = statistics_columns();
  EXPECT_EQ(explained_under("statistics.csv"), std::set<std::string>(columns.begin(), columns.end()));
}

using DocumentationOfInterface = OutputTest;

TEST_F(DocumentationOfInterface, EveryDatasetIsExplainedAndNoOther)
{
  InterfaceSamples<2> nothing;
  InterfaceWriter<2>(directory, MPI_COMM_SELF, Provenance()).write(nothing);
  std::set<std::string> datasets = {"points", "connectivity"}; // which XDMF does not call attributes
  const std::string text = content("interface.xdmf"), mark = "<Attribute Name=\"";
  for (std::size_t begin = text.find(mark); begin != std::string::npos; begin = text.find(mark, begin))
  {
    begin += mark.size();
    datasets.insert(text.substr(begin, text.find('"', begin) - begin));
  }
  EXPECT_EQ(explained_under("interface.h5"), datasets);
}
