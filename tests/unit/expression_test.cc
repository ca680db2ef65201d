// SPDX-License-Identifier: LGPL-2.1-or-later
// Expressions: what they mean, and that those which muParser would take for something else are refused.
#include <gemmule/base/exceptions.h>
#include <gemmule/parameters/all_parameters.h>
#include <gemmule/parameters/expression.h>
#include <gemmule/parameters/expression_checker.h>
#include <gemmule/parameters/expression_names.h>

#include <deal.II/base/function.h>
#include <deal.II/base/mu_parser_internal.h>
#include <deal.II/base/numbers.h>
#include <deal.II/base/point.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <map>
#include <regex>
#include <set>

namespace Gemmule::Testing
{
using namespace Gemmule::Parameters;

namespace
{
  constexpr double x = 0.3, y = -0.7, t = 0.2;

  /** At the point (x, y) and the time t. */
  double value_of(const std::string &expression)
  {
    const auto function = make_function<2>(expression, 1, "here");
    function->set_time(t);
    return function->value(dealii::Point<2>(x, y));
  }

  /** What is said about the expression, without the place; fails if nothing is. */
  std::string refusal_of(const std::string &expression)
  {
    try
    {
      make_function<2>(expression, 1, "here");
    }
    catch (const ParameterError &error)
    {
      return error.complaint;
    }
    ADD_FAILURE() << "accepted: " << expression;
    return "";
  }

  void expect_refusal(const std::string &expression, const std::string &end)
  {
    const std::string refusal = refusal_of(expression);
    EXPECT_EQ(refusal.find("the expression '" + expression + "' "), 0u) << refusal;
    ASSERT_GE(refusal.size(), end.size()) << expression;
    EXPECT_EQ(refusal.substr(refusal.size() - end.size()), end) << expression;
  }
} // namespace

TEST(Expression, OperatorsBindAsInMathematics)
{
  const std::vector<std::pair<std::string, double>> cases = {{"-x^2", -x * x},
                                                             {"(-x)^2", x * x},
                                                             {"2^-x", std::pow(2., -x)},
                                                             {"2^-x^2", std::pow(2., -x * x)},
                                                             {"2^-x*3", 3. * std::pow(2., -x)},
                                                             {"2^3^2", 512.},
                                                             {"x/y/2", x / y / 2.},
                                                             {"2/-x*y", 2. / -x * y},
                                                             {"x-y-2", x - y - 2.},
                                                             {"x--y", x + y},
                                                             {"1/2*x", 0.5 * x},
                                                             {"-sin(x)^2", -std::sin(x) * std::sin(x)},
                                                             {"2-3*-x", 2. + 3. * x},
                                                             {"1.e2 + .5 + 5. + 1E-1 + 007", 112.6}};
  for (const auto &[expression, value] : cases)
    EXPECT_DOUBLE_EQ(value_of(expression), value) << expression;
}

TEST(Expression, ConditionsMeanWhatTheySay)
{
  const std::vector<std::pair<std::string, double>> cases = {
      {"if(x>0 && y<1, 2, 1)", 2.},
      {"if(x>0&&y>0, 2, 1)", 1.}, // which muParser does not understand without blanks
      {"if(x<0||y<0, 2, 1)", 2.},
      {"(x>0) ? 1 : 2", 1.},
      {"x<0 ? 1 : y>0 ? 2 : 3", 3.},
      {"x>0 ? y>0 ? 1 : 2 : 3", 2.},
      {"x<0 ? 1 : 2 + 10", 12.},
      {"1 + x > 0 ? 1 : 2", 1.},
      {"if(x<0 && y<0 || x>0, 1, 2)", 1.},
      {"if(x>0 || y<0 && x<0, 1, 2)", 1.},
      {"if(!(x>0), 1, 2)", 2.},
      {"if(!(x<0) && !(y>0), 1, 2)", 1.},
      {"if(!!(x>0), 1, 2)", 1.},
      {"if(!(x>0) == (y>0), 1, 2)", 1.},
      {"if(!(x!=-1 && y!=x), 1, 2)", 2.},
      {"if((x>0) == (y>0), 1, 2)", 2.},
      {"if((x>0) != (y>0), 1, 2)", 1.},
      {"if(if(x>0, y>0, y<0), 1, 2)", 2.},
      {"if(x>0 ? y>0 : y<0, 1, 2)", 2.},
      {"if(x>0, if(y>0, 1, 2), 3)", 2.},
      {"if(x==0.3, 1, 2) + if(x<=-1, 10, 20)", 21.},
      {"10*if(x>0, 1, 2) + (y>0 ? 100 : 200)", 210.},
      {"if(x-1>-1 && -y<=0.7, 1, 2)", 1.},
      {"max(if(x>0, 5, 0), 2)", 5.}};
  for (const auto &[expression, value] : cases)
    EXPECT_DOUBLE_EQ(value_of(expression), value) << expression;
}

TEST(Expression, ComparisonsInARowAreRefused)
{
  expect_refusal("if(-0.1<x<0.1,2,1)",
                 "compares more than two values at once in '-0.1<x<0.1': the result of "
                 "'-0.1<x', which is true or false, would be compared with '0.1'. Write "
                 "'-0.1<x && x<0.1'.");
  expect_refusal("if(0<=x<y<1,2,1)", "Write '0<=x && x<y && y<1'.");
  expect_refusal("if(x==y==t,2,1)", "Write 'x==y && y==t'.");
  expect_refusal("if(x<y==t,2,1)", "Write 'x<y && y==t'.");
  expect_refusal("if(x!=y!=t,2,1)", "Write 'x!=y && y!=t'.");
  expect_refusal("(-1<x<1) ? 1 : 2", "Write '-1<x && x<1'.");
  expect_refusal("if(x>0 && 0 < sin(x) + 1 < 2*y, 1, 2)", "Write '0<sin(x) + 1 && sin(x) + 1<2*y'.");
  expect_refusal("if((x<y)<t,2,1)", "Write 'x<y && y<t'.");
  expect_refusal("if(x<(y<t),2,1)", "Write 'x<y && y<t'.");
  expect_refusal("if(((x<y))<=t,2,1)", "Write 'x<y && y<=t'.");
  expect_refusal("if((x==y)==t,2,1)", "Write 'x==y && y==t'.");
  expect_refusal("if(x<y==y<t,2,1)", "Write '(x<y)==(y<t)'.");
  expect_refusal("if(x<y==(y<t),2,1)", "Write '(x<y)==(y<t)'.");
  expect_refusal("if((x<y)!=y<t,2,1)", "Write '(x<y)!=(y<t)'.");
  expect_refusal("if((x<y)<(y<t),2,1)", "compared with == and !=.");
  expect_refusal("if((x<y)==1,2,1)", "Write 'x<y'.");
  expect_refusal("if((x<y)==0,2,1)", "Write '!(x<y)'.");
  expect_refusal("if(1!=(x<y),2,1)", "Write '!(x<y)'.");
}

TEST(Expression, ConditionsAreNoNumbers)
{
  expect_refusal("(x>0)*2", "Write 'if(x>0, 2, 0)'.");
  expect_refusal("2*(x>0)", "Write 'if(x>0, 2, 0)'.");
  expect_refusal("(x+1)*(x>0 && y>0)", "Write 'if(x>0 && y>0, x+1, 0)'.");
  expect_refusal("(x<0)+1", "Write 'if(x<0, 1, 0)' in the place of '(x<0)'.");
  expect_refusal("1-(x<0)", "Write 'if(x<0, 1, 0)' in the place of '(x<0)'.");
  expect_refusal("2^(x<0)", "Write 'if(x<0, 1, 0)' in the place of '(x<0)'.");
  expect_refusal("(x>0)*(y>0)", "'if((x>0) && (y>0), 1, 0)' for a number.");
  expect_refusal("!(x>0)*2", "Write 'if(!(x>0), 2, 0)'.");
  expect_refusal("if(x>0, y>0, y<0)*2", "Write 'if(if(x>0, y>0, y<0), 2, 0)'.");
  expect_refusal("-(x>0)", "Write 'if(x>0, -1, 0)'.");
  expect_refusal("sin(x>0)", "Write 'if(x>0, 1, 0)' in its place.");
  expect_refusal("max(x, y>0)", "Write 'if(y>0, 1, 0)' in its place.");
  expect_refusal("if(x>0, 1, y>0)", "Write 'if(y>0, 1, 0)' in the place of 'y>0'.");
  expect_refusal("x>0 ? x<1 : 2", "Write 'if(x<1, 1, 0)' in the place of 'x<1'.");
  expect_refusal("x>0",
                 "is a condition, true or false, and no number. Write 'if(x>0, 1, 0)' with the two numbers "
                 "that are meant, or 'x-0' if its sign is.");
  expect_refusal("x^2<1-y^2", "or 'x^2-(1-y^2)' if its sign is.");
  expect_refusal("x>0 && y>0", "Write 'if(x>0 && y>0, 1, 0)' with the two numbers that are meant.");
  expect_refusal("(x==y)", "Write 'if(x==y, 1, 0)' with the two numbers that are meant.");
}

TEST(Expression, NumbersAreNoConditions)
{
  expect_refusal("if(x,1,2)",
                 "has the number 'x' where a condition is expected, as the first argument of 'if'. "
                 "Write a comparison, for example 'x>0'.");
  expect_refusal("if(1,1,2)", "Write a comparison, for example 'x>0'.");
  expect_refusal("x ? 1 : 2", "in front of '?'. Write a comparison, for example 'x>0'.");
  expect_refusal("if(x && y>0,1,2)", "beside '&&'. Write a comparison, for example 'x>0'.");
  expect_refusal("if(x>0 || 1,1,2)", "beside '||'. Write a comparison, for example 'x>0'.");
  expect_refusal("if(x==1 || 2,1,2)", "beside '||'. Write 'x==1 || x==2'.");
  expect_refusal("if(!x,1,2)", "for example '!(x>0)'.");
  expect_refusal("if(!x>0,1,2)", "for example '!(x>0)'.");
}

TEST(Expression, OperatorsOfOtherLanguagesAreTranslated)
{
  for (const auto &[expression, remedy] : std::vector<std::pair<std::string, std::string>>{
           {"x**2", "Write '^' for a power."},
           {"if(x=<1,1,2)", "Write '<='."},
           {"if(x=>1,1,2)", "Write '>='."},
           {"if(x =! y,1,2)", "Write '!='."},
           {"if(x<>y,1,2)", "Write '!='."},
           {"if(x===y,1,2)", "Write '=='."},
           {"if(x>0 & y>0,1,2)", "Write '&&' between two comparisons that both have to hold."},
           {"if(x>0 and y>0,1,2)", "Write '&&'."},
           {"if(x>0 OR y>0,1,2)", "Write '||'."},
           {"if(not (x>0),1,2)", "Write '!', for example '!(x>0)'."},
           {"5%3", "Write x-y*floor(x/y) for the remainder of x/y."},
           {"[x]+1", "Write parentheses: ( )."}})
    expect_refusal(expression, remedy);
  for (const char *const assignment : {"x=1", "if(x=1,1,2)", "x:=1", "x+=1", "y = x^2", "if(x>0, y=1, 2)"})
    EXPECT_NE(refusal_of(assignment).find("has an assignment '='; comparisons are written =="),
              std::string::npos)
        << assignment;
  EXPECT_NE(refusal_of("|x|").find("abs(x)"), std::string::npos);
}

TEST(Expression, ProductsHaveTheirSign)
{
  expect_refusal("2x", "has no operator between '2' and 'x'. Write '2*x' for a product.");
  expect_refusal("2 x", "Write '2*x' for a product.");
  expect_refusal("2pi", "Write '2*pi' for a product.");
  expect_refusal("x y", "Write 'x*y' for a product.");
  expect_refusal("x(y+1)", "Write 'x*(...)' for a product.");
  expect_refusal("(x+1)(y+1)", "Write '(x+1)*(...)' for a product.");
  expect_refusal("sin(x)cos(y)", "Write 'sin(x)*cos(...)' for a product.");
  expect_refusal("1/2x",
                 "Write '(2*x)' if all of it stands below the fraction line, '2*x' if only its first part "
                 "does.");
  expect_refusal("1 000", "Numbers are written without blanks in them.");
  expect_refusal("(x>0) 2", "Write '&&' or '||' there.");
}

TEST(Expression, PowersAndNumbersAreTakenAtTheirWord)
{
  expect_refusal("(x^2+y^2)^1/2", "Write '(x^2+y^2)^(1/2)'.");
  EXPECT_DOUBLE_EQ(value_of("(x^2+y^2)^(1/2)"), std::hypot(x, y));
  expect_refusal("--x", "as in -(-x).");
  for (const char *const number : {"1e-3e", "1e", "1.2.3", "1_000", "0x10", "2e+x"})
    EXPECT_NE(refusal_of(number).find("which is no number. Numbers are written"), std::string::npos)
        << number;
  for (const char *const number : {"1e400", "1e-400"})
    EXPECT_NE(refusal_of(number).find("too large or too small"), std::string::npos) << number;
}

TEST(Expression, SyntaxErrorsNameTheirPlace)
{
  for (const auto &[expression, complaint] : std::vector<std::pair<std::string, std::string>>{
           {"x+", "lacks a number, a name or a parenthesis behind '+', at its end."},
           {"x+*y", "lacks a number, a name or a parenthesis behind '+', at its character 3."},
           {"2*(x+(y-1)", "lacks a ')' for the '(' at its character 3."},
           {"x+1)", "has a ')' without its '(', at its character 4."},
           {"1+()", "has empty parentheses, at its character 3."},
           {"max(x,)", "lacks a number, a name or a parenthesis behind ',', at its character 7."},
           {"x>0 ? 1", "has a '?' without its ':', at its end."},
           {"1 : 2", "has a ':' without its '?', at its character 3."},
           {"(1,2)", "has a comma in parentheses that belong to no function, at its character 3."}})
    EXPECT_NE(refusal_of(expression).find(complaint), std::string::npos) << refusal_of(expression);
  // the place in the whole, not in the component
  try
  {
    make_function<2>("x+1; 2*(y", 2, "here");
    FAIL() << "accepted";
  }
  catch (const ParameterError &error)
  {
    EXPECT_NE(error.complaint.find("for the '(' at its character 8."), std::string::npos) << error.complaint;
  }
}

TEST(Expression, FunctionsGetTheirArguments)
{
  expect_refusal("if(x>0,1)",
                 "gives 2 arguments to 'if', which takes 3. Write 'if(c, a, b)': a where the condition "
                 "c holds, b elsewhere.");
  expect_refusal("sin(x,y)", "gives 2 arguments to 'sin', which takes 1. Write 'sin(a)': sine; angles are in "
                             "radians.");
  expect_refusal("max()", "which takes at least 1. Write 'max(a, b, ...)': largest of the numbers.");
  expect_refusal("sin x", "Write 'sin(x)'.");
  expect_refusal("sin^2(x)", "Write a power behind the argument, as in sin(x)^2.");
  expect_refusal("2*if", "Write 'if(c, a, b)'.");
}

TEST(Expression, UnknownNamesGetTheNearestOne)
{
  for (const auto &[expression, remedy] : std::vector<std::pair<std::string, std::string>>{
           {"PI", "Did you mean 'pi'? Names are in small letters."},
           {"SIN(x)", "Did you mean 'sin'? Names are in small letters."},
           {"X+1", "Did you mean 'x'? Names are in small letters."},
           {"x1", "Did you mean 'x'?"},
           {"xy", "Write 'x*y' for a product."},
           {"2*sinx", "Write 'sin(x)'."},
           {"sinus(x)", "Did you mean 'sin'?"},
           {"sqr(x)", "Write 'x^2' with the argument in the place of x."},
           {"sqrtt(x)", "Did you mean 'sqrt'?"},
           {"aatn2(y,x)", "Did you mean 'atan2'?"},
           {"arcsin(x)", "Did you mean 'asin'?"},
           {"sgn(x)", "Did you mean 'sign'?"},
           {"fabs(x)", "Did you mean 'abs'?"},
           {"erf(x)", "Write '1-erfc(x)' with the argument in the place of x."},
           {"Heaviside(x)", "Write 'if(x>0, 1, 0)' with the argument in the place of x."},
           {"r-1", "Write 'sqrt(x^2+y^2)' for the distance from the origin."},
           {"cos(theta)", "Write 'atan2(y, x)' for the angle around the origin."},
           {"z", "In two dimensions the coordinates are x and y."}})
    expect_refusal(expression, remedy);
  EXPECT_NE(refusal_of("e^x").find("'exp(x)'"), std::string::npos);
  EXPECT_NE(refusal_of("int(x)").find("'rint' for the nearest integer"), std::string::npos);
  EXPECT_NE(refusal_of("rand_seed(1)").find("random numbers"), std::string::npos);
  const std::string list = refusal_of("0.5+epsilon");
  for (const char *const part : {"The variables are x, y and t, the constants pi", "the functions if, abs,",
                                 "'gemmule --help-expressions' explains them."})
    EXPECT_NE(list.find(part), std::string::npos) << list;
  EXPECT_THROW(make_function<2>("t", 1, "here", false), ParameterError);
  EXPECT_NO_THROW(make_function<3>("z", 1, "here", false));
}

TEST(Expression, ForeignCharactersAreNamed)
{
  for (const auto &[character, part] : std::vector<std::pair<std::string, std::string>>{
           {"\u2212", "'\u2212' (minus sign, U+2212) as its character 2. Write '-'."},
           {"\u2013", "(en dash, U+2013) as its character 2. Write '-'."},
           {"\u00D7", "(multiplication sign, U+00D7) as its character 2. Write '*'."},
           {"\u22C5", "(dot operator, U+22C5) as its character 2. Write '*'."},
           {"\u2264", "(less-than or equal to, U+2264) as its character 2. Write '<='."},
           {"\uFF0B", "(fullwidth character, U+FF0B) as its character 2. Write '+'."},
           {"\u200B", "has a zero-width space (U+200B) as its character 2. Delete it"},
           {"\u00A0+", "has a no-break space (U+00A0) as its character 2. Put a blank in its place."}})
    EXPECT_NE(refusal_of("x" + character + "y").find(part), std::string::npos)
        << refusal_of("x" + character + "y");
  EXPECT_NE(refusal_of("x\u00B2").find("(superscript two, U+00B2) as its character 2. Write '^2'."),
            std::string::npos);
  EXPECT_NE(refusal_of("2*\u03C0").find("(Greek letter pi, U+03C0) as its character 3. Write 'pi'."),
            std::string::npos);
}

TEST(Expression, DepthAndLengthHaveLimits)
{
  const auto nested = [](const unsigned int n) { return std::string(n, '(') + "x" + std::string(n, ')'); };
  EXPECT_DOUBLE_EQ(value_of(nested(150)), x);
  EXPECT_NE(refusal_of(nested(4000)).find("is nested too deeply."), std::string::npos);
  std::string power = "x", condition = "x>0", sum = "x";
  for (unsigned int i = 0; i < 4000; ++i)
    power += "^x";
  EXPECT_NE(refusal_of(power).find("is nested too deeply."), std::string::npos);
  EXPECT_NE(refusal_of("if(" + std::string(4000, '!') + "(x>0),1,2)").find("is nested too deeply."),
            std::string::npos);
  for (unsigned int i = 1; i < 4000; ++i)
    sum += "+x";
  EXPECT_NEAR(value_of(sum), 4000 * x, 1e-6);
  EXPECT_NE(refusal_of(sum + std::string(3000, ' ') + "+1").find("more than the 10000 that are possible"),
            std::string::npos);
}

TEST(Expression, EveryListedFunctionHasItsValue)
{
  const double pi = dealii::numbers::PI;
  const std::map<std::string, std::vector<std::pair<std::string, double>>> cases = {
      {"if", {{"if(1<2, 3, 4)", 3.}, {"if(1>2, 3, 4)", 4.}}},
      {"abs", {{"abs(-2)", 2.}}},
      {"sign", {{"sign(-2)", -1.}, {"sign(0)", 0.}, {"sign(0.1)", 1.}}},
      {"sqrt", {{"sqrt(2)", std::sqrt(2.)}}},
      {"pow", {{"pow(2, 3)", 8.}}},
      {"exp", {{"exp(2)", std::exp(2.)}}},
      {"log", {{"log(10)", std::log(10.)}}},
      {"ln", {{"ln(10)", std::log(10.)}}},
      {"log2", {{"log2(8)", 3.}}},
      {"log10", {{"log10(1000)", 3.}}},
      {"sin", {{"sin(1)", std::sin(1.)}}},
      {"cos", {{"cos(1)", std::cos(1.)}}},
      {"tan", {{"tan(1)", std::tan(1.)}}},
      {"cot", {{"cot(1)", 1. / std::tan(1.)}}},
      {"sec", {{"sec(1)", 1. / std::cos(1.)}}},
      {"csc", {{"csc(1)", 1. / std::sin(1.)}}},
      {"asin", {{"asin(-1)", -pi / 2.}}},
      {"acos", {{"acos(-1)", pi}}},
      {"atan", {{"atan(-1)", -pi / 4.}}},
      {"atan2", {{"atan2(1, -1)", 0.75 * pi}, {"atan2(-1, 0)", -pi / 2.}}},
      {"sinh", {{"sinh(1)", std::sinh(1.)}}},
      {"cosh", {{"cosh(1)", std::cosh(1.)}}},
      {"tanh", {{"tanh(1)", std::tanh(1.)}}},
      {"asinh", {{"asinh(1)", std::asinh(1.)}}},
      {"acosh", {{"acosh(2)", std::acosh(2.)}}},
      {"atanh", {{"atanh(0.5)", std::atanh(0.5)}}},
      {"erfc", {{"erfc(0.5)", std::erfc(0.5)}}},
      {"floor", {{"floor(1.7)", 1.}, {"floor(-1.2)", -2.}}},
      {"ceil", {{"ceil(1.2)", 2.}, {"ceil(-1.7)", -1.}}},
      {"rint", {{"rint(1.4)", 1.}, {"rint(2.5)", 3.}, {"rint(-2.5)", -2.}, {"rint(-0.6)", -1.}}},
      {"min", {{"min(3, 1, 2)", 1.}, {"min(4)", 4.}}},
      {"max", {{"max(3, 1, 2)", 3.}}},
      {"sum", {{"sum(3, 1, 2)", 6.}}},
      {"avg", {{"avg(3, 1, 2)", 2.}}}};
  for (const ExpressionFunction &function : expression_functions())
  {
    ASSERT_EQ(cases.count(function.name), 1u) << function.name << " has no test";
    for (const auto &[expression, value] : cases.at(function.name))
      EXPECT_DOUBLE_EQ(value_of(expression), value) << expression;
  }
  EXPECT_EQ(cases.size(), expression_functions().size());
  for (const ExpressionConstant &constant : expression_constants())
    EXPECT_DOUBLE_EQ(value_of(constant.name), constant.value) << constant.name;
}

TEST(Expression, NoFunctionOfTheLibraryIsForgotten)
{
  // Refused: random numbers, 'int', which rounds, and 'erf', which deal.II lists and does not define.
  const std::set<std::string> refused = {"rand", "rand_seed", "int", "erf"};
  for (const std::string &name : dealii::internal::FunctionParser::get_function_names())
    EXPECT_NE(find_expression_function(name) != nullptr, refused.count(name) == 1) << name;
}

TEST(Expression, HelpNamesAllThatIsKnown)
{
  const std::string help = expression_help();
  for (const ExpressionFunction &function : expression_functions())
    EXPECT_NE(help.find("\n  " + function.usage + " "), std::string::npos) << function.usage;
  for (const ExpressionConstant &constant : expression_constants())
    EXPECT_NE(help.find("\n  " + constant.name + " "), std::string::npos) << constant.name;
  for (const ExpressionOperator &operation : expression_operators())
    EXPECT_NE(help.find("\n  " + operation.symbols + " "), std::string::npos) << operation.symbols;
  // The examples at its end can be used as they stand.
  std::istringstream lines(help.substr(help.find("Examples:") + 10));
  unsigned int n = 0;
  for (std::string line; std::getline(lines, line); ++n)
    EXPECT_TRUE(std::isfinite(value_of(line.substr(2, line.find("  ", 2) - 2)))) << line;
  EXPECT_EQ(n, 4u);
}

TEST(Expression, AllThatAreShippedAreAccepted)
{
  const std::filesystem::path top(GEMMULE_SOURCE_DIRECTORY);
  unsigned int n = 0;
  for (const auto &entry : std::filesystem::recursive_directory_iterator(top / "parameters"))
    if (entry.path().extension() == ".prm")
    {
      EXPECT_NO_THROW(AllParameters().parse(entry.path().string())) << entry.path();
      ++n;
    }
  EXPECT_GT(n, 10u);

  // In the documentation: lines that set an expression, in a file or on the command line.
  n = 0;
  const std::regex assignment(
      "(Level set|Prescribed tension|Initial concentration|Initial total concentration|"
      "Boundary velocity) *= *([^\"`#]+)");
  std::vector<std::filesystem::path> files = {top / "README.md"};
  for (const auto &entry : std::filesystem::directory_iterator(top / "doc"))
    if (entry.path().extension() == ".md")
      files.push_back(entry.path());
  for (const auto &file : files)
  {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);)
    {
      std::smatch found;
      if (!std::regex_search(line, found, assignment))
        continue;
      const std::string expression = found[2];
      const unsigned int n_components = 1 + std::count(expression.begin(), expression.end(), ';');
      EXPECT_NO_THROW(make_function<2>(expression, n_components, file.string())) << line;
      ++n;
    }
  }
  EXPECT_GT(n, 0u);
}
} // namespace Gemmule::Testing
