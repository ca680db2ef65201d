// Parameter files that are well formed, with values that do not fit together, and wrong expressions.
#include "bad_input_fixture.h"

namespace Gemmule::Testing
{
using BadValues = BadInput;

TEST_F(BadValues, LevelsInWrongOrder)
{
  expect_file_error(
      "subsection Mesh\nset Bulk level = 5\nset Membrane level = 4\nend\n",
      {"case.prm:3: Mesh/Membrane level", "is 4", "'Bulk level' = 5", "Bulk level <= Membrane level"});
  expect_file_error("subsection Mesh\nset Membrane level = 8\nend\n",
                    {"case.prm: default value: Mesh/Phase boundary level", "is 7", "'Membrane level' = 8"});
}

TEST_F(BadValues, CompositionBoundsInWrongOrder)
{
  expect_file_error(
      "subsection Mesh\nset Composition upper bound = 0.01\nend\n",
      {"case.prm:2: Mesh/Composition upper bound", "is 0.01", "'Composition lower bound' = 0.05"});
}

TEST_F(BadValues, TimeStepsInWrongOrder)
{
  expect_file_error("subsection Time stepping\nset Initial time step = 1\nend\n",
                    {"case.prm:2: Time stepping/Initial time step", "is 1", "'Largest time step' = 0.05"});
  expect_file_error(
      "subsection Time stepping\nset Smallest time step = 0.01\nend\n",
      {"case.prm:2: Time stepping/Smallest time step", "is 0.01", "'Initial time step' = 0.001"});
}

TEST_F(BadValues, OutputTimeAfterTheEnd)
{
  expect_file_error("set End time = 1\nsubsection Output\nset Output times = 0.5, 1.5\nend\n",
                    {"case.prm:3: Output/Output times", "1.5", "'End time' = 1"});
}

TEST_F(BadValues, EmptyBox)
{
  expect_file_error("subsection Domain\nset Lower corner = 0, 1\nend\n",
                    {"Domain/Upper corner", "has to be larger", "1 <= 1"});
}

TEST_F(BadValues, BoxThatCubesDoNotFill)
{
  expect_file_error(
      "subsection Domain\nset Upper corner = 1, 2\nend\n",
      {"case.prm:2: Domain/Upper corner", "multiple of the shortest", "edge 2 is 3", "shortest 2"});
}

TEST_F(BadValues, CornerWithWrongNumberOfCoordinates)
{
  expect_file_error("subsection Domain\nset Lower corner = -1\nend\n", {"case.prm:2", "at least 2 numbers"});
  expect_file_error("subsection Domain\nset Lower corner = -1, -1, -1\nset Upper corner = 1, 1, 1\nend\n",
                    {"case.prm:2: Domain/Lower corner", "has 3 numbers, but 'Dimension' is 2"});
}

TEST_F(BadValues, ExpressionThatDoesNotParse)
{
  expect_file_error("subsection Membrane\nset Level set = x^2+2*(y^2-0.25\nend\n",
                    {"case.prm:2: Membrane/Level set",
                     "'x^2+2*(y^2-0.25' cannot be understood: Missing parenthesis", "for example 'x^2"});
}

TEST_F(BadValues, ExpressionWithUnknownName)
{
  expect_file_error(
      "subsection Membrane\nset Initial concentration = 0.5+epsilon\nend\n",
      {"case.prm:2: Membrane/Initial concentration", "Unexpected token \"epsilon", "x, y and t"});
  // z is no variable in two dimensions.
  expect_file_error("subsection Membrane\nset Prescribed tension = 1+z\nend\n",
                    {"case.prm:2: Membrane/Prescribed tension", "Unexpected token \"z"});
  expect_file_error("subsection Membrane\nset Initial total concentration = radius\nend\n",
                    {"case.prm:2: Membrane/Initial total concentration", "Unexpected token \"radius"});
}

TEST_F(BadValues, EmptyExpression)
{
  expect_file_error("subsection Membrane\nset Level set =\nend\n",
                    {"case.prm:2", "'Membrane/Level set'", "an expression"});
  expect_file_error("subsection Domain\nset Boundary velocity = y;\nend\n",
                    {"case.prm:2: Domain/Boundary velocity", "'y;' has an empty component"});
}

TEST_F(BadValues, ExpressionWithWrongNumberOfComponents)
{
  expect_file_error("subsection Domain\nset Boundary velocity = y\nend\n",
                    {"case.prm:2: Domain/Boundary velocity", "has 1 component instead of 2", "semicolons"});
  expect_file_error("subsection Domain\nset Boundary velocity = y; 0; 0\nend\n",
                    {"has 3 components instead of 2"});
  expect_file_error("subsection Membrane\nset Level set = x; y\nend\n", {"has 2 components instead of 1"});
}

TEST_F(BadValues, ExpressionThatIsNotFinite)
{
  expect_file_error("subsection Membrane\nset Level set = log(x^2+y^2)\nend\n",
                    {"case.prm:2: Membrane/Level set", "value -inf at (0, 0), t = 0", "finite number"});
  expect_file_error("subsection Domain\nset Boundary velocity = sqrt(x); 0\nend\n",
                    {"case.prm:2: Domain/Boundary velocity", "nan at (-1, -1)"});
}

TEST_F(BadValues, ExpressionWithRandomNumbers)
{
  expect_file_error("subsection Membrane\nset Initial concentration = 0.5+0.01*rand()\nend\n",
                    {"case.prm:2: Membrane/Initial concentration", "random numbers"});
}
} // namespace Gemmule::Testing
