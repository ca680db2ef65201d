// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/characters.h>
#include <gemmule/parameters/expression_tokens.h>
#include <gemmule/parameters/text.h>

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

namespace Gemmule::Parameters
{
namespace
{
  using Position = std::string::size_type;

  bool is_digit(const char c)
  {
    return c >= '0' && c <= '9';
  }

  bool is_letter(const char c)
  {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  }

  /** What is taken for an operator in other languages or by a slip, and what to do. */
  const std::vector<std::pair<std::string, std::string>> &false_operators()
  {
    static const std::vector<std::pair<std::string, std::string>> list = {
        {"===", "Write '=='."},
        {"!==", "Write '!='."},
        {"&&&", "Write '&&'."},
        {"|||", "Write '||'."},
        {"**", "Write '^' for a power."},
        {"=<", "Write '<='."},
        {"=>", "Write '>='."},
        {"=!", "Write '!='."},
        {"<>", "Write '!='."},
        {"><", "Write '!='."},
        {"~=", "Write '!='."},
        {"<<", "Write '<'."},
        {">>", "Write '>'."},
        {"//", "Write '/', with 'floor' around the quotient if it is to be an integer."}};
    return list;
  }

  const std::vector<std::string> &true_operators()
  {
    // Longer ones first.
    static const std::vector<std::string> list = {"&&", "||", "<=", ">=", "==", "!=", "+", "-",
                                                  "*",  "/",  "^",  "<",  ">",  "!",  "?", ":"};
    return list;
  }

  std::string remedy_for_character(const char c)
  {
    switch (c)
    {
    case '&':
      return "Write '&&' between two comparisons that both have to hold.";
    case '|':
      return "Write '||' between two comparisons of which one has to hold, or abs(x) for an absolute value.";
    case '[':
    case ']':
    case '{':
    case '}':
      return "Write parentheses: ( ).";
    case '%':
      return "Write x-y*floor(x/y) for the remainder of x/y.";
    case '"':
    case '\'':
    case '`':
      return "Expressions are written without quotation marks, derivatives as formulas.";
    case '~':
      return "Write '!' for 'not', for example !(x>0).";
    case '#':
      return "A comment begins there, which is not possible here.";
    case '.':
      return "Write '*' for a product; numbers have a digit beside their point.";
    case '\\':
      return "Write '/' for a quotient.";
    case '$':
    case '@':
    default:
      return "Remove it: expressions consist of numbers, names, parentheses, commas and the operators + - * "
             "/ ^ < "
             "<= > >= == != && || ! ? :.";
    }
  }

  [[noreturn]] void refuse_assignment()
  {
    throw ExpressionError("has an assignment '='; comparisons are written ==, <=, >= and !=.", "");
  }

  /** Where the longest number that starts there ends. */
  Position end_of_number(const std::string &text, Position i)
  {
    while (i < text.size() && is_digit(text[i]))
      ++i;
    if (i < text.size() && text[i] == '.')
      ++i;
    while (i < text.size() && is_digit(text[i]))
      ++i;
    if (i < text.size() && (text[i] == 'e' || text[i] == 'E'))
    {
      Position exponent = i + 1;
      if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-'))
        ++exponent;
      if (exponent < text.size() && is_digit(text[exponent]))
      {
        i = exponent;
        while (i < text.size() && is_digit(text[i]))
          ++i;
      }
    }
    return i;
  }

  ExpressionToken read_number(const std::string &text, const Position begin)
  {
    const Position end = end_of_number(text, begin);
    const std::string number = text.substr(begin, end - begin);
    Position last = end;
    while (last < text.size() && (is_digit(text[last]) || is_letter(text[last]) || text[last] == '.'))
      ++last;
    const std::string rest = text.substr(end, last - end), whole = number + rest;
    // Letters that begin a name of their own are a forgotten '*', which the grammar finds.
    const bool is_exponent =
        !rest.empty() && (rest[0] == 'e' || rest[0] == 'E') && (rest.size() == 1 || !is_letter(rest[1]));
    if (!rest.empty() && (!is_letter(rest[0]) || rest[0] == '_' || is_exponent))
      throw ExpressionError("has " + in_quotes(whole) + ", which is no number.",
                            "Numbers are written 2, 0.5 or 1e-3, without signs that group their digits.");
    if (number == "0" && (rest[0] == 'x' || rest[0] == 'X') && rest.size() > 1)
      throw ExpressionError("has " + in_quotes(whole) + ", which is no number.",
                            "Numbers are written in decimals.");

    double value = 0.;
    const std::from_chars_result result =
        std::from_chars(number.data(), number.data() + number.size(), value);
    if (result.ec == std::errc::result_out_of_range || !std::isfinite(value))
      throw ExpressionError("has the number " + in_quotes(number) +
                                ", which is too large or too small to compute with.",
                            "Write a number between 1e-300 and 1e300, or 0.");
    return {ExpressionToken::number, number, begin};
  }

  ExpressionToken read_operator(const std::string &text, const Position begin)
  {
    for (const auto &[symbol, remedy] : false_operators())
      if (text.compare(begin, symbol.size(), symbol) == 0)
        throw ExpressionError("has " + in_quotes(symbol) + ", which is no operator.", remedy);
    for (const std::string &symbol : true_operators())
      if (text.compare(begin, symbol.size(), symbol) == 0)
        return {ExpressionToken::operation, symbol, begin};
    if (text[begin] == '=')
      refuse_assignment();
    throw ExpressionError("has the character " + in_quotes(text.substr(begin, 1)) +
                              ", which has no meaning in expressions.",
                          remedy_for_character(text[begin]));
  }
} // namespace

std::vector<ExpressionToken> expression_tokens(const std::string &expression)
{
  if (const auto foreign = find_foreign_character(expression))
    throw ExpressionError("has " + foreign->name + " as its character " + std::to_string(foreign->column) +
                              ".",
                          foreign->remedy);

  std::vector<ExpressionToken> tokens;
  for (Position i = 0; i < expression.size(); i = tokens.back().behind())
  {
    i = expression.find_first_not_of(" \t\r\n", i);
    if (i == std::string::npos)
      break;
    const char c = expression[i];
    if (is_digit(c) || (c == '.' && i + 1 < expression.size() && is_digit(expression[i + 1])))
      tokens.push_back(read_number(expression, i));
    else if (is_letter(c))
    {
      Position end = i;
      while (end < expression.size() && (is_letter(expression[end]) || is_digit(expression[end])))
        ++end;
      tokens.push_back({ExpressionToken::name, expression.substr(i, end - i), i});
    }
    else if (c == '(')
      tokens.push_back({ExpressionToken::opening_parenthesis, "(", i});
    else if (c == ')')
      tokens.push_back({ExpressionToken::closing_parenthesis, ")", i});
    else if (c == ',')
      tokens.push_back({ExpressionToken::comma, ",", i});
    else
      tokens.push_back(read_operator(expression, i));
  }
  tokens.push_back({ExpressionToken::end, "", expression.size()});
  return tokens;
}
} // namespace Gemmule::Parameters
