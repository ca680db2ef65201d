// SPDX-License-Identifier: LGPL-2.1-or-later
// Thousands of wrong parameter files and command lines: each is accepted, or refused by a UserError with a
// message of one line; none crashes, hangs or ends in another exception. What is accepted can be printed and
// read back.
//
// In the environment: GEMMULE_FUZZ_INPUTS (number of inputs), GEMMULE_FUZZ_SEED, GEMMULE_FUZZ_ONLY (only the
// input of this number, to repeat a failure; it is left in fuzz-input.prm).
#include <gemmule/application/command_line.h>
#include <gemmule/base/exceptions.h>
#include <gemmule/parameters/all_parameters.h>
#include <gemmule/parameters/schema.h>
#include <gemmule/parameters/text.h>

#include <deal.II/base/parameter_handler.h>

#include <csignal>
#include <gtest/gtest.h>
#include <iostream>

#include "mutator.h"
#include "support/run_program.h"
#include "support/test_size.h"

namespace Gemmule::Testing
{
namespace
{
  unsigned long environment(const char *name, const unsigned long otherwise)
  {
    const char *const text = std::getenv(name);
    return text == nullptr ? otherwise : std::stoul(text);
  }

  /** For the signal handler: all it may look at. */
  volatile std::sig_atomic_t input_under_test = 0;

  extern "C" void say_which_input(const int signal)
  {
    char text[] = "fuzz: signal    at input          (repeat with GEMMULE_FUZZ_ONLY)\n";
    text[13] = static_cast<char>('0' + signal / 10 % 10);
    text[14] = static_cast<char>('0' + signal % 10);
    long n = input_under_test;
    for (int i = 32; i > 24; --i, n /= 10)
      text[i] = static_cast<char>('0' + n % 10);
    if (write(STDERR_FILENO, text, sizeof(text) - 1) < 0)
      _exit(2);
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }

  std::string read(const std::filesystem::path &path)
  {
    std::ifstream stream(path, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
  }

  std::string printed(const AllParameters &parameters)
  {
    std::ostringstream text;
    parameters.print(text);
    return text.str();
  }

  class Fuzz : public ::testing::Test
  {
  protected:
    void SetUp() override
    {
      for (const int signal : {SIGALRM, SIGSEGV, SIGABRT, SIGFPE})
        std::signal(signal, say_which_input);
    }
    void TearDown() override
    {
      alarm(0);
      for (const int signal : {SIGALRM, SIGSEGV, SIGABRT, SIGFPE})
        std::signal(signal, SIG_DFL);
    }

    static std::vector<std::string> corpus()
    {
      std::vector<std::string> files{printed({})};
      const std::filesystem::path top(GEMMULE_SOURCE_DIRECTORY);
      std::vector<std::filesystem::path> paths;
      for (const char *folder : {"parameters", "tests/bad_input/files"})
        for (const auto &entry : std::filesystem::recursive_directory_iterator(top / folder))
          if (entry.path().extension() == ".prm")
            paths.push_back(entry.path());
      // the order of a directory differs between machines
      std::sort(paths.begin(), paths.end());
      for (const auto &path : paths)
        files.push_back(read(path));
      return files;
    }

    static std::vector<std::string> all_parameters()
    {
      AllParameters parameters;
      dealii::ParameterHandler prm;
      parameters.add_parameters(prm);
      std::vector<std::string> names;
      const Parameters::Schema schema(prm);
      for (const auto &entry : schema.entries())
        names.push_back(entry.first);
      return names;
    }

    static std::vector<std::string> words()
    {
      std::vector<std::string> result = {
          "subsection ", "end\n", "set ", "=",  "\n", "#", "\\\n", ";",    "penalty", "sin(", "if(x,", "nan",
          "phase",       "\t",    "\r\n", "\"", "{}", "/", "**",   "rand", "_pi",     "e",    "x=1",   "pi"};
      for (const std::string &name : all_parameters())
      {
        result.push_back(Parameters::Schema::split(name).second);
        result.push_back(name);
      }
      return result;
    }

    /** Calls @p attempt with each number, after seeding the mutator for it. */
    template <typename Attempt>
    void repeat(const unsigned long n_inputs, const Attempt &attempt)
    {
      const unsigned long seed = environment("GEMMULE_FUZZ_SEED", 1);
      const unsigned long only = environment("GEMMULE_FUZZ_ONLY", n_inputs);
      std::cout << "seed " << seed << ", " << n_inputs << " inputs" << std::endl;
      unsigned long n_accepted = 0;
      for (unsigned long i = 0; i < n_inputs; ++i)
      {
        if (only < n_inputs && i != only)
          continue;
        input_under_test = i;
        mutator.seed(1000003 * seed + i);
        n_accepted += attempt();
        ASSERT_FALSE(HasFatalFailure()) << "input " << i;
        ASSERT_FALSE(HasNonfatalFailure()) << "input " << i << "; repeat it with GEMMULE_FUZZ_ONLY";
      }
      std::cout << n_accepted << " accepted" << std::endl;
      // Inputs that are all refused by the first line of the parser would test nothing behind it.
      if (only >= n_inputs && n_inputs >= 100)
      {
        EXPECT_GT(n_accepted, n_inputs / 50);
        EXPECT_LT(n_accepted, n_inputs - n_inputs / 10);
      }
    }

    /** A message for a user: one line that says something. */
    static void expect_message(const std::string &message)
    {
      EXPECT_GT(message.size(), 20u);
      EXPECT_EQ(message.find("internal"), std::string::npos) << message;
      EXPECT_EQ(Parameters::printable(message).find('\n'), std::string::npos);
      EXPECT_LT(message.size(), 2000u) << message;
    }

    Mutator mutator{corpus(), words()};
    const TemporaryDirectory directory;
  };
} // namespace

TEST_F(Fuzz, ParameterFiles)
{
  const auto names = all_parameters();
  const std::string file =
      std::getenv("GEMMULE_FUZZ_ONLY") == nullptr ? directory.file("fuzz.prm") : "fuzz-input.prm";
  const auto attempt = [&]
  {
    std::ofstream(file, std::ios::binary) << mutator.file();
    const auto assignments = mutator.assignments(names);
    alarm(20);
    AllParameters parameters;
    try
    {
      parameters.parse(file, assignments);
    }
    catch (const UserError &error)
    {
      expect_message(error.what());
      EXPECT_EQ(printed(parameters), printed({})) << "a failure has left something behind";
      return false;
    }
    catch (const std::exception &error)
    {
      ADD_FAILURE() << "not a message for users: " << error.what();
      return false;
    }
    // What is accepted is written to the output directory, and has to be the same case when read back.
    const std::string first = printed(parameters);
    try
    {
      AllParameters again;
      again.parse(directory.write("again.prm", first));
      EXPECT_EQ(printed(again), first);
    }
    catch (const std::exception &error)
    {
      ADD_FAILURE() << "what was accepted cannot be read back: " << error.what();
    }
    return true;
  };
  repeat(environment("GEMMULE_FUZZ_INPUTS", 1000), attempt);
}

TEST_F(Fuzz, CommandLines)
{
  const auto names = all_parameters();
  const auto attempt = [&]
  {
    const auto arguments = mutator.arguments(names);
    std::vector<const char *> pointers;
    for (const std::string &argument : arguments)
      pointers.push_back(argument.c_str());
    alarm(20);
    try
    {
      const CommandLine command = CommandLine::parse(pointers.size(), pointers.data());
      AllParameters().parse("", command.overrides);
    }
    catch (const UserError &error)
    {
      expect_message(error.what());
      return false;
    }
    catch (const std::exception &error)
    {
      ADD_FAILURE() << "not a message for users: " << error.what();
    }
    return true;
  };
  repeat(environment("GEMMULE_FUZZ_INPUTS", 1000), attempt);
}

// The whole way of --check: mesh, membrane, first flow. Few by default, because each is a process of its own.
TEST_F(Fuzz, Check)
{
  const auto names = all_parameters();
  const bool keep = std::getenv("GEMMULE_FUZZ_ONLY") != nullptr;
  const auto attempt = [&]
  {
    std::string content;
    std::vector<std::string> assignments;
    // Those that the parser refuses are tested above: look for one that goes further.
    for (unsigned int i = 0; i < 40; ++i)
    {
      content = mutator.file();
      directory.write("fuzz.prm", content);
      try
      {
        AllParameters().parse(directory.file("fuzz.prm"), assignments);
        break;
      }
      catch (const std::exception &)
      {
      }
    }
    if (keep)
      std::ofstream("fuzz-input.prm", std::ios::binary) << content;
    const Result result = run_gemmule(directory, "fuzz.prm --check --set 'Mesh/Largest number of cells=2000'",
                                      1, time_limit(100));
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1) << "exit code " << result.exit_code << "\n"
                                                                << result.out << result.err << "\n"
                                                                << content;
    EXPECT_EQ(result.err.find("internal error"), std::string::npos) << result.err;
    if (result.exit_code == 1)
      expect_message(result.err);
    return result.exit_code == 0;
  };
  repeat(environment("GEMMULE_FUZZ_CHECKS", 20), attempt);
}
} // namespace Gemmule::Testing
