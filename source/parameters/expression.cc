// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/parameters/expression.h>
#include <gemmule/parameters/expression_checker.h>
#include <gemmule/parameters/section.h>
#include <gemmule/parameters/text.h>

#include <deal.II/base/function_parser.h>
#include <deal.II/base/numbers.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>

namespace Gemmule
{
namespace
{
  /** deal.II writes what muParser complains about to std::cerr before it throws; we report it ourselves. */
  class SilencedErrorStream
  {
  public:
    SilencedErrorStream() : original(std::cerr.rdbuf(discarded.rdbuf())) {}
    ~SilencedErrorStream() { std::cerr.rdbuf(original); }
    SilencedErrorStream(const SilencedErrorStream &) = delete;
    SilencedErrorStream &operator=(const SilencedErrorStream &) = delete;

  private:
    std::ostringstream discarded;
    std::streambuf *original;
  };

  std::string complaint(const dealii::ExceptionBase &error)
  {
    std::ostringstream text;
    error.print_info(text);
    const std::string marker = "The parser said: ";
    const std::string::size_type start = text.str().find(marker);
    std::string said = dealii::Utilities::trim(
        start == std::string::npos ? text.str() : text.str().substr(start + marker.size()));
    // Some of muParser's sentences have a full stop, some have none.
    while (!said.empty() && said.back() == '.')
      said.pop_back();
    return Parameters::shortened(said);
  }

  /** The expression for muParser, component by component. @throws Parameters::ExpressionError */
  std::string checked_components(const std::string &expression, const Parameters::ExpressionScope &scope)
  {
    std::string result;
    std::string::size_type begin = 0;
    while (true)
    {
      const std::string::size_type end = std::min(expression.find(';', begin), expression.size());
      if (dealii::Utilities::trim(expression.substr(begin, end - begin)).empty())
        throw Parameters::ExpressionError("has an empty component.", "");
      // Blanks in the place of the components before, so that the places in messages are those in the whole.
      result += Parameters::checked_expression(
                    std::string(begin, ' ') + expression.substr(begin, end - begin), scope)
                    .text;
      if (end == expression.size())
        return result;
      result += ";";
      begin = end + 1;
    }
  }

  template <int dim>
  std::string example(const unsigned int n_components, const bool of_time)
  {
    std::string text = of_time ? "'x^2 + 2*y^2 - 0.25*cos(2*pi*t)" : "'x^2 + 2*y^2 - 0.25*cos(pi*x)";
    for (unsigned int i = 1; i < n_components; ++i)
      text += "; 0.5*y";
    const std::string variables =
        dim == 2 ? (of_time ? "x, y and t" : "x and y") : (of_time ? "x, y, z and t" : "x, y and z");
    return " Write an expression in " + variables + ", for example " + text + "'.";
  }
} // namespace

template <int dim>
std::unique_ptr<dealii::Function<dim>> make_function(const std::string &expression,
                                                     const unsigned int n_components,
                                                     const std::string &where, const bool of_time)
{
  const auto fail = [&](const std::string &reason, const bool has_remedy = false)
  {
    throw ParameterError(where, "the expression " + Parameters::in_quotes(expression) + " " + reason +
                                    (has_remedy ? "" : example<dim>(n_components, of_time)));
  };

  // Not split_string_list(), which swallows an empty component at the end.
  const unsigned int n_given = 1 + std::count(expression.begin(), expression.end(), ';');
  if (n_given != n_components)
    fail("has " + std::to_string(n_given) + (n_given == 1 ? " component" : " components") + " instead of " +
         std::to_string(n_components) + "; components are separated by semicolons.");
  std::string for_parser;
  try
  {
    for_parser = checked_components(expression, {dim, of_time});
  }
  catch (const Parameters::ExpressionError &error)
  {
    fail(error.what(), error.has_remedy);
  }

  auto function = std::make_unique<dealii::FunctionParser<dim>>(n_components);
  try
  {
    const SilencedErrorStream silence;
    const std::string variables =
        dealii::FunctionParser<dim>::default_variable_names() + (of_time ? ",t" : "");
    function->initialize(variables, for_parser, {{"pi", dealii::numbers::PI}}, of_time);
    // The parser looks at the text only when it is first evaluated.
    for (unsigned int i = 0; i < n_components; ++i)
      function->value(dealii::Point<dim>(), i);
  }
  catch (const dealii::ExceptionBase &error)
  {
    fail("cannot be understood: " + complaint(error) + ".");
  }
  catch (...) // muParser's own exceptions have no common base with others
  {
    fail("cannot be understood.");
  }
  return function;
}

template <int dim>
Parameters::ExpressionTree expression_tree(const std::string &expression)
{
  return Parameters::checked_expression(expression, {dim, /*of_time =*/false}).tree;
}

template <int dim>
std::string not_finite_complaint(const dealii::Function<dim> &function,
                                 const std::vector<dealii::Point<dim>> &points)
{
  for (const dealii::Point<dim> &point : points)
    for (unsigned int i = 0; i < function.n_components; ++i)
    {
      const double value = function.value(point, i);
      if (std::isfinite(value))
        continue;
      // The sign of NaN says nothing.
      std::string text = "the expression has the value " +
                         (std::isnan(value) ? "nan" : Parameters::to_text(value)) + " at (";
      for (unsigned int d = 0; d < dim; ++d)
        text += (d == 0 ? "" : ", ") + Parameters::short_number(point[d]);
      return text + "), t = " + Parameters::short_number(function.get_time()) +
             ". It has to be a finite number there; look for divisions by zero and for roots or logarithms "
             "of "
             "negative numbers.";
    }
  return "";
}

template <int dim>
void check_finite(const dealii::Function<dim> &function, const std::vector<dealii::Point<dim>> &points,
                  const std::string &where)
{
  if (const std::string complaint = not_finite_complaint(function, points); !complaint.empty())
    throw ParameterError(where, complaint);
}

#define INSTANTIATE(dim)                                                                                     \
  template std::unique_ptr<dealii::Function<dim>> make_function<dim>(const std::string &, unsigned int,      \
                                                                     const std::string &, bool);             \
  template Parameters::ExpressionTree expression_tree<dim>(const std::string &);                             \
  template std::string not_finite_complaint<dim>(const dealii::Function<dim> &,                              \
                                                 const std::vector<dealii::Point<dim>> &);                   \
  template void check_finite<dim>(const dealii::Function<dim> &, const std::vector<dealii::Point<dim>> &,    \
                                  const std::string &);
INSTANTIATE(2)
INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Gemmule
