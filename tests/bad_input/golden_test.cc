// SPDX-License-Identifier: LGPL-2.1-or-later
// The messages about wrong input, word by word.
//
// Each file of tests/bad_input/files is a wrong parameter file. Its first comment says what is wrong, its
// second is the message. command_lines.txt has wrong command lines, each followed by its message. A new one
// needs no code: add the file or the line and run this program with GEMMULE_WRITE_MESSAGES=1 in the
// environment, which writes the present messages into the sources; then read what it has written as somebody
// would who sees the message for the first time: does it say what is wrong, where, and what to do?
#include <gemmule/application/case_check.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/parameters/all_parameters.h>
#include <gemmule/parameters/text.h>

#include <algorithm>

#include "bad_input_fixture.h"

namespace Gemmule::Testing
{
namespace
{
  const std::filesystem::path sources = std::filesystem::path(GEMMULE_SOURCE_DIRECTORY) / "tests/bad_input";

  bool writes_messages()
  {
    return std::getenv("GEMMULE_WRITE_MESSAGES") != nullptr;
  }

  std::string read(const std::filesystem::path &path)
  {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  std::vector<std::string> names_of_files()
  {
    std::vector<std::string> names;
    for (const auto &entry : std::filesystem::directory_iterator(sources / "files"))
      names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
  }

  struct Block
  {
    std::string command, message;
  };

  std::vector<Block> command_lines()
  {
    std::vector<Block> blocks;
    std::istringstream stream(read(sources / "command_lines.txt"));
    for (std::string line; std::getline(stream, line);)
      if (line.rfind("$ gemmule", 0) == 0)
        blocks.push_back({line.substr(9), ""});
      else if (line.rfind("gemmule: ", 0) == 0)
        blocks.at(blocks.size() - 1).message = line;
    return blocks;
  }
} // namespace

class BadParameterFile : public BadInput, public ::testing::WithParamInterface<std::string>
{
protected:
  /** What the program says about case.prm, by the same steps but in this process: a new one takes a second.
   */
  std::string message_in_this_process() const
  {
    const auto before = std::filesystem::current_path();
    std::filesystem::current_path(directory.path);
    std::string message = "none: the case was accepted";
    AllParameters parameters;
    try
    {
      parameters.parse("case.prm");
      if (parameters.dimension == 2)
        check_case<2>(parameters, MPI_COMM_SELF);
      else
        check_case<3>(parameters, MPI_COMM_SELF);
    }
    catch (const ParameterError &error)
    {
      message = parameters.located(error).what();
    }
    catch (const UserError &error)
    {
      message = error.what();
    }
    catch (const std::exception &error)
    {
      message = std::string("no UserError: ") + error.what();
    }
    std::filesystem::current_path(before);
    return Parameters::printable(message);
  }
};

TEST_P(BadParameterFile, GetsItsMessage)
{
  const std::filesystem::path source = sources / "files" / (GetParam() + ".prm");
  const std::string content = read(source);
  const auto begin = content.find("\n# ") + 3, end = content.find('\n', begin);
  ASSERT_TRUE(begin > 3 && end != std::string::npos) << "the message is to be the second comment";
  const std::string expected = content.substr(begin, end - begin);

  directory.write("case.prm", content);
  const std::string message = "gemmule: error: " + message_in_this_process();
  if (writes_messages())
    std::ofstream(source, std::ios::binary) << content.substr(0, begin) + message + content.substr(end);
  else
    EXPECT_EQ(message, expected);
}

INSTANTIATE_TEST_SUITE_P(Files, BadParameterFile, ::testing::ValuesIn(names_of_files()),
                         [](const auto &info) { return info.param; });

// One of each kind goes through the program itself: exit code, output, nothing written.
class BadCase : public BadInput, public ::testing::WithParamInterface<std::string>
{
};

TEST_P(BadCase, EndsTheProgram)
{
  const std::string content = read(sources / "files" / (GetParam() + ".prm"));
  directory.write("case.prm", content);
  const std::string message = message_of("case.prm");
  EXPECT_NE(content.find("\n# " + message + "\n"), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(Kinds, BadCase,
                         ::testing::Values("unknown_key", "very_long_line", "zero_bytes", "box_empty",
                                           "dimension_three", "expression_unknown_name",
                                           "expression_chained_comparison", "no_break_space",
                                           "velocity_pumps", "shape_crosses_itself", "shape_leaves_the_box",
                                           "capillary_number_denormal", "double_well_unknown"),
                         [](const auto &info) { return info.param; });

class BadCommandLine : public BadInput, public ::testing::WithParamInterface<unsigned int>
{
};

TEST_P(BadCommandLine, GetsItsMessage)
{
  const Block block = command_lines()[GetParam()];
  directory.write("case.prm", "subsection Mesh\nset Membrane level = 4\nset Phase boundary level = 4\nend\n");
  directory.write("occupied", "text");
  std::filesystem::create_directory(directory.path / "folder");

  const std::string message = message_of(block.command);
  EXPECT_EQ(directory.read("occupied"), "text");
  if (writes_messages())
  {
    const std::filesystem::path source = sources / "command_lines.txt";
    std::string content = read(source);
    const std::string head = "$ gemmule" + block.command + "\n";
    const auto begin = content.find("\n" + head) + 1 + head.size();
    content.replace(begin, block.message.empty() ? 0 : block.message.size() + 1, message + "\n");
    std::ofstream(source, std::ios::binary) << content;
  }
  else
    EXPECT_EQ(message, block.message) << "gemmule" << block.command;
}

INSTANTIATE_TEST_SUITE_P(Lines, BadCommandLine,
                         ::testing::Range(0u, static_cast<unsigned int>(command_lines().size())));

TEST(BadInputTable, IsLarge)
{
  // A wrong path would leave nothing to test, and nobody would notice.
  EXPECT_GE(names_of_files().size(), 100u);
  EXPECT_GE(command_lines().size(), 30u);
}
} // namespace Gemmule::Testing
