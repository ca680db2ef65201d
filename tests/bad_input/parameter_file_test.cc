// Wrong parameter files: names, syntax and values.
#include "bad_input_fixture.h"

namespace Gemmule::Testing
{
using BadParameterFile = BadInput;

TEST_F(BadParameterFile, UnknownKeySuggestsTheNearestWithItsValues)
{
  expect_file_error("# a comment\nsubsection Fluid\n  set Capilary nummber = 1\nend\n",
                    {"case.prm:3: there is no parameter 'Capilary nummber' in section 'Fluid'",
                     "Did you mean 'Capillary number' (a number > 0)?"});
}

TEST_F(BadParameterFile, UnknownKeyWithoutLikenessListsTheSection)
{
  expect_file_error("subsection Fluid\n  set Colour = 1\nend\n",
                    {"case.prm:2", "'Colour' in section 'Fluid'", "'Capillary number', 'Viscosity ratio'"});
}

TEST_F(BadParameterFile, KeyOfAnotherSection)
{
  expect_file_error("set Capillary number = 1\n",
                    {"case.prm:1", "no parameter 'Capillary number' at the top level", "in section 'Fluid'"});
}

TEST_F(BadParameterFile, MisspeltKeyOfAnotherSection)
{
  expect_file_error("subsection Fluid\nset Cahn numbers = 1\nend\n",
                    {"case.prm:2", "Did you mean 'Cahn number' in section 'Membrane'?"});
}

TEST_F(BadParameterFile, UnknownSectionSuggestsTheNearest)
{
  expect_file_error("subsection Fluids\nend\n",
                    {"case.prm:1: there is no section 'Fluids' at the top level", "Did you mean 'Fluid'?"});
}

TEST_F(BadParameterFile, UnknownSectionWithoutLikenessListsTheSections)
{
  expect_file_error("subsection Bending\nend\n", {"case.prm:1", "'Bending'", "'Fluid'", "'Time stepping'"});
}

TEST_F(BadParameterFile, UnknownSubsection)
{
  expect_file_error("subsection Membrane\n  subsection Arc length constraint\n  end\nend\n",
                    {"case.prm:2", "no section 'Arc length constraint' in section 'Membrane'",
                     "Did you mean 'Arclength constraint'?"});
}

TEST_F(BadParameterFile, MissingEndAtTheEndOfTheFile)
{
  expect_file_error("\nsubsection Fluid\n  set Capillary number = 1\n",
                    {"case.prm:2: the section 'Fluid' that starts here has no 'end'"});
}

TEST_F(BadParameterFile, MissingEndBeforeTheNextSection)
{
  expect_file_error("subsection Fluid\n\nsubsection Mesh\nend\n",
                    {"case.prm:3: there is no section 'Mesh' in section 'Fluid'",
                     "is an 'end' missing for the section that starts at case.prm:1?"});
}

TEST_F(BadParameterFile, EndTooMany)
{
  expect_file_error("subsection Fluid\nend\nend\n", {"case.prm:3: this 'end' closes no section"});
}

TEST_F(BadParameterFile, TextAfterEnd)
{
  expect_file_error("subsection Fluid\nend Fluid\n", {"case.prm:2: nothing may follow 'end'", "'Fluid'"});
}

TEST_F(BadParameterFile, KeyGivenTwice)
{
  expect_file_error("set End time = 1\nset Dimension = 2\nset End  time = 2\n",
                    {"case.prm:3: the parameter 'End time' is given twice, first at case.prm:1"});
}

TEST_F(BadParameterFile, KeyGivenTwiceInReopenedSection)
{
  expect_file_error(
      "subsection Fluid\nset Viscosity ratio = 1\nend\nsubsection Fluid\nset Viscosity ratio = 2\nend\n",
      {"case.prm:5", "'Fluid/Viscosity ratio' is given twice, first at case.prm:2"});
}

TEST_F(BadParameterFile, LineWithoutSet)
{
  expect_file_error("End time = 1\n",
                    {"case.prm:1: the line 'End time = 1' cannot be understood", "Is 'set' missing"});
}

TEST_F(BadParameterFile, MeaninglessLine)
{
  expect_file_error("hello\n", {"case.prm:1: the line 'hello' cannot be understood", "'subsection NAME'"});
}

TEST_F(BadParameterFile, SetWithoutEqualsSign)
{
  expect_file_error("set End time 1\n", {"case.prm:1: 'set End time 1' has no '='"});
}

TEST_F(BadParameterFile, SetWithoutName)
{
  expect_file_error("set = 1\n", {"case.prm:1: 'set = 1' names no parameter"});
}

TEST_F(BadParameterFile, Include)
{
  expect_file_error("include other.prm\n", {"case.prm:1: 'include' is not supported"});
}

TEST_F(BadParameterFile, BackslashInTheLastLine)
{
  expect_file_error("set End time = \\\n", {"case.prm:1", "ends with a backslash"});
}

TEST_F(BadParameterFile, LineNumberAfterContinuedLines)
{
  expect_file_error("set Output \\\n  directory \\\n  = a\nset End time = x\n", {"case.prm:4", "'End time'"});
}

TEST_F(BadParameterFile, NumberWithLetters)
{
  expect_file_error(
      "set End time = 1s\n",
      {"case.prm:1: the value '1s' of the parameter 'End time' is not allowed; expected a number > 0."});
}

TEST_F(BadParameterFile, NumberOutOfRange)
{
  expect_file_error("subsection Fluid\nset Capillary number = 0\nend\n",
                    {"case.prm:2", "'0'", "'Fluid/Capillary number'", "expected a number > 0."});
}

TEST_F(BadParameterFile, NumbersThatAreNone)
{
  expect_file_error("set End time = nan\n", {"case.prm:1", "'nan'", "expected a number > 0."});
  expect_file_error("set End time = inf\n", {"case.prm:1", "'inf'", "expected a number > 0."});
  expect_file_error("set End time = 1e999\n", {"case.prm:1", "'1e999'", "expected a number > 0."});
  expect_file_error("set End time =\n", {"case.prm:1", "the value ''", "expected a number > 0."});
}

TEST_F(BadParameterFile, IntegerWithFractionOrSign)
{
  expect_file_error("subsection Mesh\nset Bulk level = 2.5\nend\n",
                    {"case.prm:2", "an integer from 0 to 20"});
  expect_file_error("subsection Mesh\nset Bulk level = -1\nend\n", {"case.prm:2", "an integer from 0 to 20"});
}

TEST_F(BadParameterFile, DimensionFour)
{
  expect_file_error("set Dimension = 4\n", {"case.prm:1", "expected an integer from 2 to 3"});
}

TEST_F(BadParameterFile, DimensionThreeIsToCome)
{
  expect_file_error("set Dimension = 3\n", {"Dimension = 3 is not available yet", "Set Dimension = 2"});
}

TEST_F(BadParameterFile, WrongBoolean)
{
  expect_file_error("subsection Output\nset Progress line = maybe\nend\n",
                    {"case.prm:2", "'maybe'", "true or false"});
}

TEST_F(BadParameterFile, WrongChoice)
{
  expect_file_error("subsection Membrane\nset Tension model = constant\nend\n",
                    {"case.prm:2", "'constant'", "one of: 'phase field', 'prescribed'"});
  expect_file_error("subsection Membrane\nsubsection Arclength constraint\nset Model = Penalty\nend\nend\n",
                    {"case.prm:3", "'Membrane/Arclength constraint/Model'", "one of: 'none', 'penalty'"});
}

TEST_F(BadParameterFile, WrongList)
{
  expect_file_error("subsection Output\nset Output times = 0.1, x\nend\n",
                    {"case.prm:2", "'0.1, x'", "numbers separated by commas"});
  expect_file_error("subsection Output\nset Output times = 0.1,,0.2\nend\n",
                    {"case.prm:2", "numbers separated by commas"});
  expect_file_error("subsection Output\nset Output times = 0.1,\nend\n",
                    {"case.prm:2", "numbers separated by commas"});
}
} // namespace Gemmule::Testing
