// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/expression_names.h>
#include <gemmule/parameters/suggestion.h>
#include <gemmule/parameters/text.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cctype>
#include <limits>

namespace Gemmule::Parameters
{
namespace
{
  constexpr unsigned int any_number = std::numeric_limits<unsigned int>::max();

  struct Stranger
  {
    std::vector<std::string> names;
    std::string remedy;
  };

  /** What users of other languages and of formulas on paper write, and what it is here. */
  const std::vector<Stranger> &strangers()
  {
    static const std::vector<Stranger> list = {
        {{"and"}, "Write '&&'."},
        {{"or"}, "Write '||'."},
        {{"not"}, "Write '!', for example '!(x>0)'."},
        {{"xor"}, "Write '!=' between two comparisons in parentheses, for example '(x>0)!=(y>0)'."},
        {{"true", "false"}, "A comparison such as 'x>0' is a condition by itself."},
        {{"then", "else", "elseif", "elif"}, "Write 'if(condition, value, other value)'."},
        {{"where", "select", "ifelse", "iif", "ite", "merge"}, "Write 'if(condition, value, other value)'."},
        {{"heaviside", "step", "theta_function", "unitstep"},
         "Write 'if(x>0, 1, 0)' with the argument in the place of x."},
        {{"e", "euler"}, "Write 'exp(x)' for a power of Euler's number, or '_e' for the number itself."},
        {{"tau"}, "Write '2*pi'."},
        {{"r", "rho", "radius", "norm"}, "Write 'sqrt(x^2+y^2)' for the distance from the origin."},
        {{"theta", "phi", "angle"}, "Write 'atan2(y, x)' for the angle around the origin."},
        {{"hypot"}, "Write 'sqrt(x^2+y^2)' with the arguments in the places of x and y."},
        {{"arcsin", "arsin"}, "Did you mean 'asin'?"},
        {{"arccos", "arcos"}, "Did you mean 'acos'?"},
        {{"arctan"}, "Did you mean 'atan'?"},
        {{"arctan2"}, "Did you mean 'atan2'?"},
        {{"arcsinh", "arsinh"}, "Did you mean 'asinh'?"},
        {{"arccosh", "arcosh"}, "Did you mean 'acosh'?"},
        {{"arctanh", "artanh"}, "Did you mean 'atanh'?"},
        {{"tg", "tangens", "tangent"}, "Did you mean 'tan'?"},
        {{"sinus", "sine"}, "Did you mean 'sin'?"},
        {{"cosinus", "cosine"}, "Did you mean 'cos'?"},
        {{"deg", "degrees", "rad", "radians"}, "Angles are in radians; write 'pi/180' times one in degrees."},
        {{"ctg", "cotan", "ctan"}, "Did you mean 'cot'?"},
        {{"cosec"}, "Did you mean 'csc'?"},
        {{"sech"}, "Write '1/cosh(x)' with the argument in the place of x."},
        {{"csch"}, "Write '1/sinh(x)' with the argument in the place of x."},
        {{"coth"}, "Write '1/tanh(x)' with the argument in the place of x."},
        {{"lg"}, "Did you mean 'log10'?"},
        {{"ld", "lb"}, "Did you mean 'log2'?"},
        {{"log1p"}, "Write 'log(1+x)' with the argument in the place of x."},
        {{"expm1"}, "Write 'exp(x)-1' with the argument in the place of x."},
        {{"exp2"}, "Write '2^x' with the argument in the place of x."},
        {{"sq", "sqr", "square"}, "Write 'x^2' with the argument in the place of x."},
        {{"cbrt"}, "Write 'sign(x)*abs(x)^(1/3)' with the argument in the place of x."},
        {{"fabs", "dabs", "magnitude"}, "Did you mean 'abs'?"},
        {{"sgn", "signum"}, "Did you mean 'sign'?"},
        {{"fmin", "minimum"}, "Did you mean 'min'?"},
        {{"fmax", "maximum"}, "Did you mean 'max'?"},
        {{"mean", "average"}, "Did you mean 'avg'?"},
        {{"power"}, "Did you mean 'pow'?"},
        {{"erf"}, "Write '1-erfc(x)' with the argument in the place of x."},
        {{"mod", "fmod", "modulo", "rem"},
         "Write 'x-y*floor(x/y)' with the arguments in the places of x and y."},
        {{"round", "nint", "anint"}, "Did you mean 'rint', the nearest integer?"},
        {{"int"},
         "Write 'rint' for the nearest integer, 'floor' for the one below or 'ceil' for the one above: 'int' "
         "rounds in some languages and cuts off in others."},
        {{"trunc", "fix", "aint"}, "Write 'sign(x)*floor(abs(x))' with the argument in the place of x."},
        {{"ceiling"}, "Did you mean 'ceil'?"},
        {{"time"}, "Did you mean 't'?"},
        {{"inf", "infinity", "nan"}, "Values have to be finite numbers."}};
    return list;
  }

  std::string small(const std::string &text)
  {
    std::string result = text;
    std::transform(result.begin(), result.end(), result.begin(),
                   [](const unsigned char c) { return std::tolower(c); });
    return result;
  }

  std::string list(const std::vector<std::string> &names)
  {
    std::string text;
    for (unsigned int i = 0; i < names.size(); ++i)
      text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
    return text;
  }

  std::string row(const std::string &name, const std::string &meaning)
  {
    constexpr std::size_t width = 24;
    return "  " + name + std::string(std::max<std::size_t>(width, name.size() + 2) - name.size(), ' ') +
           meaning + "\n";
  }
} // namespace

std::vector<std::string> ExpressionScope::variables() const
{
  std::vector<std::string> names = {"x", "y"};
  if (dimension > 2)
    names.push_back("z");
  if (of_time)
    names.push_back("t");
  return names;
}

bool ExpressionScope::has_quantity(const std::string &name) const
{
  const std::vector<std::string> known = variables();
  const auto &constants = expression_constants();
  return std::find(known.begin(), known.end(), name) != known.end() ||
         std::any_of(constants.begin(), constants.end(),
                     [&](const ExpressionConstant &constant) { return constant.name == name; });
}

const std::vector<ExpressionFunction> &expression_functions()
{
  static const std::vector<ExpressionFunction> list = {
      {"if", "if(c, a, b)", "a where the condition c holds, b elsewhere", 3, 3, true},
      {"abs", "abs(a)", "absolute value"},
      {"sign", "sign(a)", "1 for positive, -1 for negative numbers, 0 for 0"},
      {"sqrt", "sqrt(a)", "square root"},
      {"pow", "pow(a, b)", "a to the power of b, the same as a^b", 2, 2},
      {"exp", "exp(a)", "exponential function, Euler's number to the power of a"},
      {"log", "log(a)", "natural logarithm (base: Euler's number)"},
      {"ln", "ln(a)", "natural logarithm, the same as log(a)"},
      {"log2", "log2(a)", "logarithm to base 2"},
      {"log10", "log10(a)", "logarithm to base 10"},
      {"sin", "sin(a)", "sine; angles are in radians"},
      {"cos", "cos(a)", "cosine"},
      {"tan", "tan(a)", "tangent"},
      {"cot", "cot(a)", "cotangent, 1/tan(a)"},
      {"sec", "sec(a)", "secant, 1/cos(a)"},
      {"csc", "csc(a)", "cosecant, 1/sin(a)"},
      {"asin", "asin(a)", "inverse sine, from -pi/2 to pi/2"},
      {"acos", "acos(a)", "inverse cosine, from 0 to pi"},
      {"atan", "atan(a)", "inverse tangent, from -pi/2 to pi/2"},
      {"atan2", "atan2(y, x)", "angle of the point (x, y) around the origin, from -pi to pi", 2, 2},
      {"sinh", "sinh(a)", "hyperbolic sine"},
      {"cosh", "cosh(a)", "hyperbolic cosine"},
      {"tanh", "tanh(a)", "hyperbolic tangent"},
      {"asinh", "asinh(a)", "inverse hyperbolic sine"},
      {"acosh", "acosh(a)", "inverse hyperbolic cosine"},
      {"atanh", "atanh(a)", "inverse hyperbolic tangent"},
      {"erfc", "erfc(a)", "complementary error function, 1 minus the error function"},
      {"floor", "floor(a)", "largest integer that is not above a"},
      {"ceil", "ceil(a)", "smallest integer that is not below a"},
      {"rint", "rint(a)", "nearest integer; halves go up"},
      {"min", "min(a, b, ...)", "smallest of the numbers", 1, any_number},
      {"max", "max(a, b, ...)", "largest of the numbers", 1, any_number},
      {"sum", "sum(a, b, ...)", "sum of the numbers", 1, any_number},
      {"avg", "avg(a, b, ...)", "mean of the numbers", 1, any_number}};
  return list;
}

const std::vector<ExpressionConstant> &expression_constants()
{
  static const std::vector<ExpressionConstant> list = {
      {"pi", dealii::numbers::PI, "3.14159..., circumference over diameter of a circle"},
      {"_pi", dealii::numbers::PI, "the same as pi"},
      {"_e", dealii::numbers::E, "2.71828..., Euler's number"}};
  return list;
}

const std::vector<ExpressionOperator> &expression_operators()
{
  static const std::vector<ExpressionOperator> list = {
      {"( )", "parentheses: what stands in them is computed first"},
      {"!", "not: turns a comparison in parentheses around, !(x>0)"},
      {"^", "power; from the right: 2^3^2 is 2^(3^2)"},
      {"- +", "sign; weaker than the power: -x^2 is -(x^2)"},
      {"* /", "product and quotient; from the left: 1/2*x is (1/2)*x"},
      {"+ -", "sum and difference"},
      {"< <= > >= == !=",
       "comparisons of two numbers; == equal, != not equal; == and != also of two comparisons "
       "in parentheses"},
      {"&&", "and: both comparisons hold"},
      {"||", "or: at least one of the comparisons holds"},
      {"c ? a : b", "a where the condition c holds, b elsewhere, the same as if(c, a, b)"}};
  return list;
}

const ExpressionFunction *find_expression_function(const std::string &name)
{
  const auto &functions = expression_functions();
  const auto found = std::find_if(functions.begin(), functions.end(),
                                  [&](const ExpressionFunction &function) { return function.name == name; });
  return found == functions.end() ? nullptr : &*found;
}

std::string remedy_for_unknown_name(const std::string &name, const bool is_called,
                                    const ExpressionScope &scope)
{
  const std::vector<std::string> variables = scope.variables();
  const std::string word = small(name);
  if (word == "z" && scope.dimension < 3)
    return "In two dimensions the coordinates are x and y.";
  if (word == "t" && !scope.of_time)
    return "An initial state has no time; the variables are " + list(variables) + ".";

  std::vector<std::string> names = variables, functions;
  for (const ExpressionConstant &constant : expression_constants())
    names.push_back(constant.name);
  for (const ExpressionFunction &function : expression_functions())
    functions.push_back(function.name);
  names.insert(names.end(), functions.begin(), functions.end());

  for (const std::string &candidate : names)
    if (small(candidate) == word)
      return "Did you mean '" + candidate + "'? Names are in small letters.";
  for (const Stranger &stranger : strangers())
    if (std::find(stranger.names.begin(), stranger.names.end(), word) != stranger.names.end())
      return stranger.remedy;
  for (const std::string &variable : variables)
    for (const std::string &function : functions)
      if (!is_called && name == function + variable &&
          find_expression_function(function)->least_arguments == 1)
        return "Write '" + function + "(" + variable + ")'.";
  if (name.size() == 2 &&
      std::find(variables.begin(), variables.end(), name.substr(0, 1)) != variables.end() &&
      std::find(variables.begin(), variables.end(), name.substr(1)) != variables.end())
    return "Write '" + name.substr(0, 1) + "*" + name.substr(1) + "' for a product.";
  // In short names one letter makes another word.
  const std::string similar = nearest(name, names);
  if (!similar.empty() && edit_distance(name, similar) <= (name.size() < 5 ? 1 : 2))
    return "Did you mean '" + similar + "'?";

  std::vector<std::string> constants;
  for (const ExpressionConstant &constant : expression_constants())
    constants.push_back(constant.name);
  return "The variables are " + list(variables) + ", the constants " + list(constants) + ", the functions " +
         list(functions) + "; 'gemmule --help-expressions' explains them.";
}

std::string expression_help()
{
  std::string text = "Expressions in parameters such as 'Membrane/Level set'\n\nVariables:\n";
  text += row("x, y", "coordinates (dimensionless length)");
  text += row("z", "third coordinate, with 'Dimension' = 3");
  text += row("t", "time (dimensionless), where the description of the parameter names it");
  text += "\nConstants:\n";
  for (const ExpressionConstant &constant : expression_constants())
    text += row(constant.name, constant.meaning);
  text += "\nOperators, from the strongest to the weakest:\n";
  for (const ExpressionOperator &operation : expression_operators())
    text += row(operation.symbols, operation.meaning);
  text += "\nFunctions:\n";
  for (const ExpressionFunction &function : expression_functions())
    text += row(function.usage, function.meaning);
  text += R"(
Rules:
  Numbers are written 2, 0.5 or 1e-3, products with their sign: 2*x, not 2x.
  A comparison is true or false and no number: if(x>0, 2, 0), not 2*(x>0).
  A value between two bounds takes two comparisons: -1<x && x<1, not -1<x<1.
  A condition is a comparison: if(x!=0, 1, 2), not if(x, 1, 2).
  The components of a vector are separated by semicolons: 0.5*y; 0.

Examples:
  x^2+2*y^2-0.25                       an ellipse, negative inside
  sqrt((x-0.1)^2+y^2)-0.4              a circle around (0.1, 0)
  if(abs(x)<0.1 && y>0, 2, 1)          2 in a strip, 1 elsewhere
  1+0.5*cos(2*atan2(y, x))             varies twice around the origin
)";
  return text;
}
} // namespace Gemmule::Parameters
