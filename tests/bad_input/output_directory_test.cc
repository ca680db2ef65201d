// SPDX-License-Identifier: LGPL-2.1-or-later
// Directories for the results that cannot be used, and names that mean something else to a shell.
#include "bad_input_fixture.h"

namespace Gemmule::Testing
{
class OutputDirectoryNames : public BadInput
{
protected:
  void SetUp() override
  {
    directory.write("case.prm",
                    "subsection Mesh\nset Membrane level = 4\nset Phase boundary level = 4\nend\n");
  }
};

TEST_F(OutputDirectoryNames, ThatMeanSomethingElseToAShellAreRefusedWithTheirPlace)
{
  directory.write("named.prm", "set End time = 1\nset Output directory = $HOME/run\n");
  EXPECT_EQ(message_of("named.prm"),
            "gemmule: error: named.prm:2: Output directory: is '$HOME/run': it holds "
            "'$HOME', which is not replaced here as a shell does it. Write out what is "
            "meant.");
  EXPECT_EQ(
      message_of("case.prm --output '~/run'"),
      "gemmule: error: command line: Output directory: is '~/run': it begins with '~', which is not replaced "
      "here as a shell does it. Write out what is meant.");
}

TEST_F(OutputDirectoryNames, ThatLeadNowhereAreRefusedBeforeAnythingIsComputed)
{
  namespace fs = std::filesystem;
  const std::string choose = "choose another one with --output or the parameter 'Output directory'.";
  fs::create_symlink("loop", directory.path / "loop");
  fs::create_symlink("nowhere", directory.path / "dangling");
  const std::string x300(300, 'x');
  std::string deep;
  for (unsigned int i = 0; i < 700; ++i)
    deep += "folder/";
  for (const std::string options : {"", " --resume"})
  {
    for (const std::string name : {"loop", "loop/run"})
      EXPECT_EQ(message_of("case.prm --output " + name + options),
                "gemmule: error: Cannot reach the output directory '" + name +
                    "' (Too many levels of symbolic links): remove the loop, or " + choose);
    for (const std::string name : {"dangling", "dangling/run"})
      EXPECT_EQ(message_of("case.prm --output " + name + options),
                "gemmule: error: Cannot create the output directory '" + name +
                    "' ('dangling' is a symbolic link to something that does not exist): " + choose);
    for (const std::string &name : {x300, "run/" + x300})
      EXPECT_NE(message_of("case.prm --output " + name + options)
                    .find("(a name in it has 300 bytes, 255 are the most): " + choose),
                std::string::npos);
    EXPECT_NE(
        message_of("case.prm --output " + deep + options).find("(it has 4900 bytes, 4000 are the most): "),
        std::string::npos);
  }
  // The first message is about the directory, although the case is wrong, too, and its fault takes longer to
  // find.
  EXPECT_NE(message_of("case.prm --output loop --set 'Membrane/Level set=(x-0.8)^2+y^2-0.25'")
                .find("Cannot reach the output directory 'loop'"),
            std::string::npos);
}

TEST_F(OutputDirectoryNames, AreCheckedForAllProcesses)
{
  std::filesystem::create_symlink("loop", directory.path / "loop");
  const Result result = run_gemmule(directory, "case.prm --output loop", 2, time_limit(60));
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("gemmule: error: Cannot reach"), std::string::npos) << result.err;
  EXPECT_EQ(result.err.find("gemmule: error: "), result.err.rfind("gemmule: error: ")) << result.err;
}
} // namespace Gemmule::Testing
