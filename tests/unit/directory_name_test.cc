// SPDX-License-Identifier: LGPL-2.1-or-later
// Names of directories that the file system takes, and that nobody means.
#include <gemmule/parameters/directory_name.h>
#include <gemmule/parameters/text.h>

#include <gtest/gtest.h>
#include <utility>
#include <vector>

using Gemmule::Parameters::flaw_of_directory_name;

namespace
{
void expect_complaint(const std::string &name, const std::string &complaint)
{
  // Invisible characters are shown by their codes.
  EXPECT_EQ(flaw_of_directory_name(name), "is " + Gemmule::Parameters::in_quotes(name) + ": " + complaint);
}

TEST(DirectoryName, ThatAShellWouldReplaceIsRefused)
{
  const std::string rest = ", which is not replaced here as a shell does it. Write out what is meant.";
  for (const char *const name : {"~", "~/run", "~somebody/run"})
    expect_complaint(name, "it begins with '~'" + rest);
  const std::vector<std::pair<std::string, std::string>> names = {{"$HOME/run", "$HOME"},
                                                                  {"a/${VAR}/run", "${VAR}"},
                                                                  {"run-$1", "$1"},
                                                                  {"run-$(date)", "$(date)"},
                                                                  {"run-$((1+1))", "$((1+1))"},
                                                                  {"%USERPROFILE%\\run", "%USERPROFILE%"},
                                                                  {"%TMP%/run", "%TMP%"},
                                                                  {"run-`date`", "`"},
                                                                  {"run*", "*"},
                                                                  {"run?", "?"}};
  for (const auto &[name, part] : names)
    expect_complaint(name, "it holds '" + part + "'" + rest);
}

TEST(DirectoryName, InQuotationMarksOrWithBackslashesIsRefused)
{
  for (const char *const name :
       {"\"run\"", "\"my run\"", "'run'", "a/'run'", "“run”", "„run“", "«run»", "a\"b"})
    expect_complaint(name, "it holds a quotation mark, which would belong to the name. Leave it out.");
  for (const char *const name : {"C:\\results\\run", "my\\ run"})
    expect_complaint(name,
                     "it holds a backslash, which would belong to the name. Separate directories by '/'.");
}

TEST(DirectoryName, WithBlanksAroundItsPartsOrADashInFrontIsRefused)
{
  for (const char *const name : {" run", "run ", "a /run", "a/ run", "\u00a0run", "run\u3000"})
    expect_complaint(name, "a name in it begins or ends with a blank. Leave the blank out.");
  for (const std::string name : {"-run", "--resume"})
    expect_complaint(name, "it begins with '-', so that commands would take it for an option. Write './" +
                               name + "' if it is meant.");
}

TEST(DirectoryName, ThatIsEmptyOrHoldsControlCharactersIsRefused)
{
  for (const char *const name : {"", "  "})
    EXPECT_EQ(flaw_of_directory_name(name),
              "is empty. Give the name of a directory; '.' is the one in which the program is started.");
  EXPECT_EQ(flaw_of_directory_name("a\tb"),
            "is 'a\\x09b', which holds a control character. Choose another name.");
  EXPECT_EQ(flaw_of_directory_name("a\nb"),
            "is 'a\\x0Ab', which holds a control character. Choose another name.");
}

TEST(DirectoryName, OfTheOrdinaryKindIsTaken)
{
  for (const char *const name :
       {"run", "my run", "bob's/run", "100%", "5% to 10%", "US$", "a~b", "backup~", "./-run", "./~", "Größe",
        ".", "..", "/", "a//b/", "/tmp/run", "a-b", "Ca=1,M=2"})
    EXPECT_EQ(flaw_of_directory_name(name), "") << name;
}
} // namespace
