#pragma once

#include <gtest/gtest.h>
#include <initializer_list>
#include <string>

#include "support/run_program.h"

namespace Gemmule::Testing
{
/** Runs the program with wrong input and looks at exit code and message. */
class BadInput : public ::testing::Test
{
protected:
  /** The program has to end with code 1 and one message that contains all fragments. */
  void expect_error(const std::string &arguments, const std::initializer_list<std::string> &fragments)
  {
    const Result result = run_gemmule(directory, arguments);
    EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
    EXPECT_EQ(result.out, "");
    const std::string prefix = "gemmule: error: ";
    EXPECT_EQ(result.err.find(prefix), 0u) << result.err;
    EXPECT_EQ(result.err.rfind(prefix), 0u) << "more than one message:\n" << result.err;
    for (const std::string &fragment : fragments)
      EXPECT_NE(result.err.find(fragment), std::string::npos) << "'" << fragment << "' is missing in:\n"
                                                              << result.err;
    // Nothing of the libraries below: neither stack traces nor banners of exceptions.
    for (const char *banner :
         {"Stacktrace", "-----", "An error occurred in", "terminate called", ".cc", "Errc"})
      EXPECT_EQ(result.err.find(banner), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << "not a message of one line:\n" << result.err;
  }

  /** The same for the content of a parameter file, checked with --check. */
  void expect_file_error(const std::string &content, const std::initializer_list<std::string> &fragments)
  {
    directory.write("case.prm", content);
    expect_error("case.prm --check", fragments);
  }

  const TemporaryDirectory directory;
};
} // namespace Gemmule::Testing
