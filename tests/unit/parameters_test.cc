// SPDX-License-Identifier: LGPL-2.1-or-later
// Parameters without the program around them: defaults, reading, printing, overrides, expressions.
#include <gemmule/base/exceptions.h>
#include <gemmule/base/raise_together.h>
#include <gemmule/parameters/all_parameters.h>
#include <gemmule/parameters/expression.h>
#include <gemmule/parameters/section.h>
#include <gemmule/parameters/suggestion.h>

#include <deal.II/base/function.h>
#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/point.h>

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <sstream>

#include "support/run_program.h"

namespace Gemmule::Testing
{
using namespace Gemmule::Parameters;

namespace
{
  std::string printed(const AllParameters &parameters)
  {
    std::ostringstream text;
    parameters.print(text);
    return text.str();
  }

  /** The message of the UserError that the action throws; fails if there is none. */
  template <typename Action>
  std::string message_of(const Action &action)
  {
    try
    {
      action();
    }
    catch (const UserError &error)
    {
      return error.what();
    }
    ADD_FAILURE() << "no UserError was thrown";
    return "";
  }
} // namespace

TEST(Parameters, DefaultsAreAValidCase)
{
  EXPECT_NO_THROW(AllParameters().check());
}

TEST(Parameters, NumbersSurvivePrintingExactly)
{
  for (const double value : {1e-7, 0.1, 1. / 3., 1e22, -std::nextafter(1., 2.), 0.05})
    EXPECT_EQ(std::stod(to_text(value)), value) << to_text(value);

  // As parameters, of all magnitudes and to the last digit: what is recorded is the case that was computed.
  const TemporaryDirectory directory;
  for (double value = std::numeric_limits<double>::min(); value < 1e300; value *= 1e11 / 3.)
  {
    AllParameters original;
    original.end_time = value;
    original.output.interface_interval = original.output.field_interval = 0.;
    original.output.output_times = {value / 3., std::nextafter(value, 0.), value};
    AllParameters read;
    read.parse(directory.write("case.prm", printed(original)));
    EXPECT_EQ(read.end_time, value);
    EXPECT_EQ(read.output.output_times, original.output.output_times);
  }
}

TEST(Parameters, EveryKindOfValueSurvivesPrintingAndParsing)
{
  AllParameters original;
  original.end_time = 1. / 3.;
  original.output_directory = "some where";
  original.checkpoint.steps_between = 4294967295u;
  original.domain.lower_corner = {-2. / 3., -1.};
  original.domain.upper_corner = {1. / 3., 1.};
  original.membrane.level_set = "if(x<=0, x^2, 2*x^2) + y^2 - 0.01";
  original.membrane.tension_model = TensionModel::prescribed;
  original.regularisation.model = RegularisationModel::update_smoothing;
  original.arclength.model = ArclengthModel::penalty;
  original.mesh.membrane_level = 5;
  original.time_stepping.adaptive = false;
  original.output.output_times = {0.1, 1. / 7.};

  const TemporaryDirectory directory;
  AllParameters read;
  read.parse(directory.write("case.prm", printed(original)));
  EXPECT_EQ(read.end_time, original.end_time);
  EXPECT_EQ(read.output_directory, original.output_directory);
  EXPECT_EQ(read.checkpoint.steps_between, original.checkpoint.steps_between);
  EXPECT_EQ(read.domain.lower_corner, original.domain.lower_corner);
  EXPECT_EQ(read.domain.upper_corner, original.domain.upper_corner);
  EXPECT_EQ(read.membrane.level_set, original.membrane.level_set);
  EXPECT_EQ(read.membrane.tension_model, TensionModel::prescribed);
  EXPECT_EQ(read.regularisation.model, RegularisationModel::update_smoothing);
  EXPECT_EQ(read.arclength.model, ArclengthModel::penalty);
  EXPECT_EQ(read.mesh.membrane_level, 5u);
  EXPECT_FALSE(read.time_stepping.adaptive);
  EXPECT_EQ(read.output.output_times, original.output.output_times);
  EXPECT_EQ(printed(read), printed(original));
}

TEST(Parameters, PrintedFileShowsTheDefaultOfWhatDiffers)
{
  AllParameters parameters;
  parameters.fluid.viscosity_ratio = 10.;
  const std::string text = printed(parameters);
  EXPECT_NE(text.find("set Viscosity ratio  = 10 # default: 1"), std::string::npos) << text;
}

TEST(Parameters, EveryDescriptionNamesItsUnit)
{
  // Counts, levels, names and switches have none; every real number has.
  dealii::ParameterHandler prm;
  AllParameters parameters;
  parameters.add_parameters(prm);
  std::ostringstream json;
  prm.print_parameters(json, dealii::ParameterHandler::JSON);
  std::istringstream lines(json.str());
  unsigned int n_reals = 0;
  std::string documentation;
  for (std::string line; std::getline(lines, line);)
    if (line.find("\"documentation\"") != std::string::npos)
    {
      EXPECT_GT(line.size(), 60u) << line;
      if (line.find("Expected: a number") != std::string::npos)
      {
        ++n_reals;
        const bool is_wall_clock = line.find("(seconds of wall clock") != std::string::npos;
        EXPECT_TRUE(is_wall_clock || line.find("dimensionless") != std::string::npos) << line;
      }
    }
  EXPECT_GT(n_reals, 20u);
}

TEST(Parameters, FileSyntax)
{
  const TemporaryDirectory directory;
  AllParameters parameters;
  parameters.parse(directory.write("case.prm", "\xEF\xBB\xBF# byte order mark, carriage returns\r\n"
                                               "  SET  End   time=3 # three\r\n"
                                               "set Output directory = a b\r\n"
                                               "subsection Membrane\r\n"
                                               "\tset Level set = x^2 \\ # a circle\r\n"
                                               "   + y^2 \\\r\n"
                                               "   - 0.1\r\n"
                                               "  subsection Arclength constraint\r\n"
                                               "    set Model = penalty\r\n"
                                               "  END\r\n"
                                               "  set Tension model = prescribed\r\n"
                                               "end\r\n"
                                               "subsection Output\r\n  set Output times = +1e-1 , 2\r\nend"));
  EXPECT_EQ(parameters.end_time, 3.);
  EXPECT_EQ(parameters.output_directory, "a b");
  EXPECT_EQ(make_function<2>(parameters.membrane.level_set, 1, "")->value(dealii::Point<2>(2, 3)), 12.9);
  EXPECT_EQ(parameters.arclength.model, ArclengthModel::penalty);
  EXPECT_EQ(parameters.membrane.tension_model, TensionModel::prescribed);
  EXPECT_EQ(parameters.output.output_times, (std::vector<double>{0.1, 2.}));
}

TEST(Parameters, CommentsHoldAnyCharacter)
{
  AllParameters parameters;
  parameters.parse_text("case.prm", "\xEF\xBB\xBF# \u00A0 \u200B \u2212 \u202E \u2028 \u03C0\n"
                                    "set End time = 3 # \u00A0\u00D7\u3000\n"
                                    "subsection Membrane # \u2013\n"
                                    "set Level set = x^2 \\ # \u00B2\n + y^2 - 0.1\nend # \u200D\n");
  EXPECT_EQ(parameters.end_time, 3.);
}

TEST(Parameters, NamesOfDirectoriesHoldAnyLetter)
{
  AllParameters parameters;
  parameters.parse_text("case.prm", "set Output directory = Ergebnisse f\u00FCr K\u00E4the \u2013 \u03C0\n");
  EXPECT_EQ(parameters.output_directory, "Ergebnisse f\u00FCr K\u00E4the \u2013 \u03C0");
}

TEST(Parameters, EveryInvisibleCharacterIsNamedWithItsPlace)
{
  const std::vector<std::pair<std::string, std::string>> characters = {
      {"\u00A0", "U+00A0"}, {"\u1680", "U+1680"}, {"\u2000", "U+2000"}, {"\u2004", "U+2004"},
      {"\u2007", "U+2007"}, {"\u200A", "U+200A"}, {"\u202F", "U+202F"}, {"\u205F", "U+205F"},
      {"\u3000", "U+3000"}, {"\u200B", "U+200B"}, {"\u200C", "U+200C"}, {"\u200D", "U+200D"},
      {"\u2060", "U+2060"}, {"\uFEFF", "U+FEFF"}, {"\u00AD", "U+00AD"}, {"\u2028", "U+2028"},
      {"\u2029", "U+2029"}, {"\u200E", "U+200E"}, {"\u200F", "U+200F"}, {"\u202A", "U+202A"},
      {"\u202E", "U+202E"}, {"\u2066", "U+2066"}, {"\u2069", "U+2069"}, {"\uFE0F", "U+FE0F"},
      {"\u3164", "U+3164"}};
  for (const auto &[character, code] : characters)
  {
    for (const auto &[line, column] :
         std::vector<std::pair<std::string, std::string>>{{character + "set End time = 1", "1"},
                                                          {"set" + character + "End time = 1", "4"},
                                                          {"set End" + character + "time = 1", "8"},
                                                          {"set End time =" + character + "1", "15"},
                                                          {"set Output directory = a" + character, "25"},
                                                          {"  \t" + character, "4"}})
    {
      const std::string message =
          message_of([&] { AllParameters().parse_text("case.prm", "# first\n" + line + "\n"); });
      EXPECT_EQ(message.find("case.prm:2: column " + column + " of '"), 0u) << message;
      EXPECT_NE(message.find("<" + code + ">"), std::string::npos) << message;
      EXPECT_NE(message.find("(" + code + "). "), std::string::npos) << message;
    }
    const std::string message =
        message_of([&] { AllParameters().parse("", {"Output directory=a" + character + "b"}); });
    EXPECT_EQ(message.find("command line: character 19 of 'Output directory=a<" + code + ">b' is "), 0u)
        << message;
  }
}

TEST(Parameters, LookAlikesAreNamedWithTheirPlace)
{
  const auto message = [&](const std::string &text)
  { return message_of([&] { AllParameters().parse_text("case.prm", text); }); };
  EXPECT_EQ(message("subsection Domain\n  set Lower corner = -1,\u20131\nend\n"),
            "case.prm:2: column 25 of '  set Lower corner = -1,\u20131' holds '\u2013' (en dash, U+2013). "
            "Write '-'.");
  EXPECT_EQ(message("set End time \uFF1D 1\n"),
            "case.prm:1: column 14 of 'set End time \uFF1D 1' holds '\uFF1D' (fullwidth character, U+FF1D). "
            "Write '='.");
  EXPECT_EQ(message("set End\u2011time = 1\n").find("case.prm:1: column 8 of "), 0u);
  EXPECT_EQ(message("subsection Fl\u00FCid\nend\n").find("case.prm:1: column 14 of "), 0u);
  EXPECT_EQ(message("set Dimension = \u0663\n").find("case.prm:1: column 17 of "), 0u);
  EXPECT_EQ(message("subsection Membrane\nset Level set = x^2 \\\n  + y^2 \\\n  \u2212 0.1\nend\n"),
            "case.prm:4: column 3 of '  \u2212 0.1' holds '\u2212' (minus sign, U+2212). Write '-'.");
}

TEST(Parameters, LineEndsOfOldMacsAreRefused)
{
  const std::string expected =
      "case.prm:1: the line holds a carriage return (\\x0D) that does not end it. Save the "
      "file with the line ends of Unix or Windows.";
  for (const char *const text : {"# all of it\rset End time = 3\r", "set End time = 3\rset Dimension = 2",
                                 "set End time = 3 # three\rset Dimension = 2\r\n"})
    EXPECT_EQ(message_of([&] { AllParameters().parse_text("case.prm", text); }), expected);
}

TEST(Parameters, LinesWithoutKeywordGetTheNearestOne)
{
  for (const auto &[line, advice] : std::vector<std::pair<std::string, std::string>>{
           {"Set End time = 1", "Write 'set' in small letters."},
           {"sEt x = 1", "Write 'set' in small letters."},
           {"Subsection Fluid", "Write 'subsection' in small letters."},
           {"SubSection Fluid", "Write 'subsection' in small letters."},
           {"End", "Write 'end' in small letters."},
           {"End time = 1", "Is 'set' missing in front of it?"},
           {"end_time = 1", "Is 'set' missing in front of it?"},
           {"Viscosity ratio = 1", "Is 'set' missing in front of it?"},
           {"x = 1", "If it sets a parameter, 'set' is missing in front of it: write 'set Name = value'."},
           {"sett End time = 1", "Did you mean 'set' instead of 'sett'?"},
           {"ste End time = 1", "Did you mean 'set' instead of 'ste'?"},
           {"et End time = 1", "Did you mean 'set' instead of 'et'?"},
           {"setEnd time = 1", "Write a blank behind 'set'."},
           {"let End time = 1", "Did you mean 'set' instead of 'let'?"},
           {"subsecton Fluid", "Did you mean 'subsection' instead of 'subsecton'?"},
           {"section Fluid", "Did you mean 'subsection' instead of 'section'?"},
           {"subsectionFluid", "Write a blank behind 'subsection'."},
           {"sub section Fluid", "A section begins with 'subsection NAME'."},
           {"ned", "Did you mean 'end'?"},
           {"ends", "Did you mean 'end'?"},
           {"endsubsection", "A section ends with 'end' on a line of its own."},
           {"}", "A section ends with 'end' on a line of its own."},
           {"Fluid", "A section begins with 'subsection Fluid' and ends with 'end'."},
           {"[Fluid]", "A section begins with 'subsection Fluid' and ends with 'end'."},
           {"Membrane {", "A section begins with 'subsection Membrane' and ends with 'end'."},
           {"End time: 1", "Write 'set End time = value'."},
           {"End time 1", "If it sets a parameter, write 'set End time = value'."},
           {"// comment", "Comments begin with '#'."},
           {"hello", "Lines are 'subsection NAME', 'set Name = value', 'end', or comments after '#'."}})
  {
    const std::string message = message_of([&] { AllParameters().parse_text("case.prm", line + "\n"); });
    EXPECT_EQ(message.find("case.prm:1: the line '" + line + "' cannot be understood. "), 0u) << message;
    EXPECT_NE(message.find(advice), std::string::npos) << message;
  }
  EXPECT_NE(message_of([] { AllParameters().parse_text("case.prm", "Include a.prm\n"); })
                .find("'include' is not supported."),
            std::string::npos);
}

TEST(Parameters, OverridesReplaceTheFile)
{
  const TemporaryDirectory directory;
  const std::string file =
      directory.write("case.prm", "set End time = 3\nsubsection Mesh\nset Bulk level = 4\nend\n");
  AllParameters parameters;
  parameters.parse(file, {"End time=4", "Membrane/Arclength constraint/Model = penalty",
                          "Membrane/Level set=if(x==0,1,x/2)", "Mesh / Membrane level=5"});
  EXPECT_EQ(parameters.end_time, 4.);
  EXPECT_EQ(parameters.mesh.bulk_level, 4u);
  EXPECT_EQ(parameters.mesh.membrane_level, 5u);
  EXPECT_EQ(parameters.arclength.model, ArclengthModel::penalty);
  EXPECT_EQ(parameters.membrane.level_set, "if(x==0,1,x/2)");
}

TEST(Parameters, FailureLeavesTheObjectAsItWas)
{
  AllParameters parameters;
  EXPECT_THROW(parameters.parse("", {"End time=4", "Mesh/Bulk level=9"}), UserError);
  EXPECT_EQ(parameters.end_time, 2.);
  EXPECT_EQ(parameters.mesh.bulk_level, 3u);
}

TEST(Parameters, CheckFindsValuesThatNoFileSet)
{
  AllParameters parameters;
  parameters.fluid.capillary_number = -1.;
  EXPECT_EQ(message_of([&] { parameters.check(); }),
            "Fluid/Capillary number: the value '-1' is not allowed; expected a number > 0.");
  parameters = AllParameters();
  parameters.time_stepping.tolerance = std::nan("");
  EXPECT_THROW(parameters.check(), ParameterError);
  parameters = AllParameters();
  parameters.membrane.surface_energy = "";
  EXPECT_THROW(parameters.check(), ParameterError);
}

TEST(Parameters, NamesOfEnergiesAreLeftToTheirRegistry)
{
  AllParameters parameters;
  parameters.membrane.double_well = "one of a user's own";
  EXPECT_NO_THROW(parameters.check());
}

TEST(Parameters, BoxFollowsTheDimension)
{
  AllParameters parameters;
  parameters.parse("", {"Dimension=3"});
  EXPECT_EQ(parameters.domain.lower<3>(), dealii::Point<3>(-1, -1, -1));
  EXPECT_EQ(parameters.domain.upper<3>(), dealii::Point<3>(1, 1, 1));
  EXPECT_EQ(parameters.domain.boundary_velocity, "0; 0; 0");
  AllParameters other;
  EXPECT_THROW(other.parse("", {"Dimension=3", "Domain/Lower corner=-1,-1"}), UserError);
}

TEST(Parameters, BoxOfSeveralCubes)
{
  Domain domain;
  domain.lower_corner = {-0.3, -0.1};
  domain.upper_corner = {0.6, 0.2};
  domain.check();
  EXPECT_EQ(domain.coarse_cells(), (std::vector<unsigned int>{3, 1}));
  EXPECT_NEAR(domain.shortest_edge(), 0.3, 1e-15);
  domain.upper_corner[0] = 0.601;
  EXPECT_THROW(domain.check(), ParameterError);
}

TEST(Suggestion, DistanceCountsEdits)
{
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("Level", "lEVEL"), 0u);
  EXPECT_EQ(edit_distance("chekc", "check"), 1u);
}

TEST(Suggestion, NearestOrNothing)
{
  EXPECT_EQ(nearest("Cahn numbr", {"Peclet number", "Cahn number", "Mach number"}), "Cahn number");
  EXPECT_EQ(nearest("cahn number", {"Mach number", "Cahn number"}), "Cahn number");
  EXPECT_EQ(nearest("Bending", {"Fluid", "Membrane"}), "");
  EXPECT_EQ(nearest("", {"a", "b"}), "");
}

TEST(Expression, VariablesTimeAndConstants)
{
  auto scalar = make_function<2>("x + 10*y + 100*t + cos(pi)", 1, "here");
  EXPECT_DOUBLE_EQ(scalar->value(dealii::Point<2>(1, 2)), 20.);
  scalar->set_time(0.5);
  EXPECT_DOUBLE_EQ(scalar->value(dealii::Point<2>(1, 2)), 70.);

  const auto vector = make_function<3>("z; x*y; -t", 3, "here");
  EXPECT_EQ(vector->n_components, 3u);
  EXPECT_DOUBLE_EQ(vector->value(dealii::Point<3>(2, 3, 4), 0), 4.);
  EXPECT_DOUBLE_EQ(vector->value(dealii::Point<3>(2, 3, 4), 1), 6.);
}

TEST(Expression, ParsingErrorsAreNotPrinted)
{
  ::testing::internal::CaptureStderr();
  const std::string message = message_of([] { make_function<2>("x+bla", 1, "Some/Place"); });
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(message.find("Some/Place: the expression 'x+bla' has the name 'bla', which is not known here."),
            0u)
      << message;
}

TEST(Expression, NotFiniteAtAPoint)
{
  const auto function = make_function<2>("1/(x-t)", 1, "here");
  EXPECT_NO_THROW(check_finite<2>(*function, {{1, 0}}, "here"));
  function->set_time(1.);
  const std::string message = message_of([&] { check_finite<2>(*function, {{2, 0}, {1, 5}}, "here"); });
  EXPECT_EQ(message.find("here: the expression has the value inf at (1, 5), t = 1."), 0u) << message;
}

TEST(Parameters, MessagesAreCompleteWhateverTheValueHolds)
{
  const std::string assignment("Output directory=a\0b", 20);
  const std::string message = message_of([&] { AllParameters().parse("", {assignment}); });
  EXPECT_EQ(
      message,
      "command line: 'Output directory=a\\x00b' holds the control character \\x00. Choose another value.");
}

TEST(ParallelErrors, WhatOneProcessFindsIsThrownByAll)
{
  const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const unsigned int last = dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) - 1;
  EXPECT_NO_THROW(raise_together("here", "", MPI_COMM_WORLD));
  EXPECT_EQ(message_of([&] { raise_together("here", rank == last ? "wrong" : "", MPI_COMM_WORLD); }),
            "here: wrong");
  // Of several, that of the first.
  EXPECT_EQ(message_of([&] { raise_together("here", std::to_string(rank), MPI_COMM_WORLD); }), "here: 0");
}
} // namespace Gemmule::Testing
