// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/expression_syntax_complaints.h>
#include <gemmule/parameters/text.h>

namespace Gemmule::Parameters
{
using Token = ExpressionToken;

std::string SyntaxComplaints::place(const unsigned int token) const
{
  return tokens[token].kind == Token::end ? "at its end"
                                          : "at its character " + std::to_string(tokens[token].position + 1);
}

void SyntaxComplaints::about_missing_operand(const unsigned int token) const
{
  throw ExpressionError("lacks a number, a name or a parenthesis " +
                            (token > 0 ? "behind '" + tokens[token - 1].text + "', " : "") + place(token) +
                            ".",
                        "");
}

void SyntaxComplaints::about_rest(const unsigned int token) const
{
  if (tokens[token].kind == Token::comma)
    throw ExpressionError("has a comma outside of parentheses; decimals are written with a point, and "
                          "components are separated by semicolons.",
                          "");
  if (tokens[token].kind == Token::closing_parenthesis)
    throw ExpressionError("has a ')' without its '(', " + place(token) + ".", "");
  throw ExpressionError("has a ':' without its '?', " + place(token) + ".",
                        "Write 'if(condition, value, other value)'.");
}

void SyntaxComplaints::about_choice_without_end(const unsigned int token) const
{
  throw ExpressionError("has a '?' without its ':', " + place(token) + ".",
                        "Write 'if(condition, value, other value)'.");
}

void SyntaxComplaints::about_two_signs(const unsigned int token) const
{
  throw ExpressionError("has two signs in a row, " + place(token) + ".",
                        "Leave them out, or put the second into parentheses, as in -(-x).");
}

void SyntaxComplaints::about_root(const ExpressionPart &base, const unsigned int token) const
{
  const Token &exponent = tokens[token + 2];
  throw ExpressionError("has '^1/', which takes the power first and divides then.",
                        "Write '" + parts.text(base) + "^(1/" +
                            (exponent.kind == Token::number ? exponent.text : "...") + ")'.");
}

void SyntaxComplaints::about_factorial(const ExpressionPart &part) const
{
  throw ExpressionError("has a '!' behind " + parts.quoted(part) + ".",
                        "'!' means 'not' and stands in front of a condition, as in !(x>0); there are no "
                        "factorials.");
}

void SyntaxComplaints::about_empty_parentheses(const unsigned int opening) const
{
  throw ExpressionError("has empty parentheses, " + place(opening) + ".", "");
}

void SyntaxComplaints::about_comma(const unsigned int token) const
{
  throw ExpressionError("has a comma in parentheses that belong to no function, " + place(token) + ".",
                        "Decimals are written with a point.");
}

void SyntaxComplaints::about_open_parenthesis(const unsigned int opening) const
{
  throw ExpressionError("lacks a ')' for the '(' " + place(opening) + ".", "");
}

void SyntaxComplaints::about_missing_argument(const ExpressionFunction &function,
                                              const unsigned int token) const
{
  const std::string &name = tokens[token].text;
  const Token &next = tokens[token + 1];
  std::string remedy = "Write '" + function.usage + "'.";
  if (next.is("^"))
    remedy = "Write a power behind the argument, as in " + name + "(x)^2.";
  else if (function.least_arguments == 1 && next.kind == Token::name && scope.has_quantity(next.text))
    remedy = "Write '" + name + "(" + next.text + ")'.";
  throw ExpressionError("names the function '" + name + "' without its argument in parentheses.", remedy);
}

void SyntaxComplaints::about_unknown_name(const unsigned int token) const
{
  const std::string &name = tokens[token].text;
  const bool is_called = tokens[token + 1].kind == Token::opening_parenthesis;
  if (name.compare(0, 4, "rand") == 0) // each process would draw numbers of its own
    throw ExpressionError("uses random numbers, which differ from process to process and from run to run.",
                          "Use sines and cosines.");
  throw ExpressionError((is_called ? "calls " : "has the name ") + in_quotes(name) +
                            (is_called ? ", which is no function here." : ", which is not known here."),
                        remedy_for_unknown_name(name, is_called, scope));
}

void SyntaxComplaints::about_missing_operator(const ExpressionPart &part, const unsigned int token) const
{
  const Token &behind = tokens[token];
  if (behind.kind == Token::name && !scope.has_quantity(behind.text) &&
      find_expression_function(behind.text) == nullptr)
    about_unknown_name(token);
  const std::string complaint =
      "has no operator between " + parts.quoted(part) + " and " + in_quotes(behind.text) + ".";
  if (part.is_truth)
    throw ExpressionError(complaint, "Write '&&' or '||' there.");
  about_forgotten_product(part, token, complaint);
}

void SyntaxComplaints::about_forgotten_product(const ExpressionPart &part, const unsigned int token,
                                               const std::string &complaint) const
{
  const Token &behind = tokens[token];
  if (behind.kind == Token::number && tokens[token - 1].kind == Token::number)
    throw ExpressionError(complaint, "Numbers are written without blanks in them.");
  const bool is_called = behind.kind == Token::opening_parenthesis || find_expression_function(behind.text);
  const std::string product = parts.text(part) + "*" +
                              (behind.kind == Token::name ? printable(shortened(behind.text)) : "") +
                              (behind.kind == Token::number ? behind.text : "") + (is_called ? "(...)" : "");
  bool is_below_a_line = false;
  for (unsigned int i = 1; i < tokens.size(); ++i)
    is_below_a_line = is_below_a_line || (tokens[i].position == part.begin && tokens[i - 1].is("/"));
  throw ExpressionError(complaint, is_below_a_line ? "Write '(" + product +
                                                         ")' if all of it stands below the fraction line, '" +
                                                         product + "' if only its first part does."
                                                   : "Write '" + product + "' for a product.");
}
} // namespace Gemmule::Parameters
