// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gtest/gtest.h>
#include <regex>
#include <string>
#include <vector>

#include "support/run_program.h"
#include "support/test_size.h"

namespace Gemmule::Testing
{
/** Runs the program with wrong input and looks at exit code, message and what is left behind. */
class BadInput : public ::testing::Test
{
protected:
  /** All files and folders below the directory, sorted; those of the test itself are left out. */
  std::vector<std::string> listing() const
  {
    std::vector<std::string> names;
    for (const auto &entry : std::filesystem::recursive_directory_iterator(directory.path))
      if (const std::string name = entry.path().filename().string(); name != ".stdout" && name != ".stderr")
        names.push_back(entry.path().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  /**
   * The program has to end with code 1 and one line on the error stream, and to write nothing else.
   * @return the line
   */
  std::string message_of(const std::string &arguments)
  {
    const auto before = listing();
    // Accepted by mistake, a case would compute for long.
    const Result result = run_gemmule(directory, arguments, 1, time_limit(120));
    EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(listing(), before) << "something was written";
    const std::string prefix = "gemmule: error: ";
    EXPECT_EQ(result.err.find(prefix), 0u) << result.err;
    EXPECT_EQ(result.err.rfind(prefix), 0u) << "more than one message:\n" << result.err;
    EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << "not a message of one line:\n" << result.err;
    return result.err.substr(0, result.err.find('\n'));
  }

  /** --check has to say that all is well, and how large the case is. */
  static void expect_accepted(const Result &checked, const std::string &name)
  {
    const std::string verdict = name + ": the parameters are valid.\n";
    EXPECT_EQ(checked.out.substr(0, verdict.size()), verdict);
    const std::regex size(
        "\\d+ cells, \\d+ unknowns of the flow, which is solved by MUMPS \\(\\d+ MB\\); \\d+ MB of memory in "
        "all\\. With 'Mesh/Largest number of cells' = \\d+ it would be about [\\d.]+ (MB|GB)\\.\n");
    EXPECT_TRUE(std::regex_match(checked.out.substr(verdict.size()), size)) << checked.out;
  }

  const TemporaryDirectory directory;
};
} // namespace Gemmule::Testing
