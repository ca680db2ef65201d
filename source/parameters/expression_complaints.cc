// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/expression_complaints.h>
#include <gemmule/parameters/text.h>

#include <algorithm>

namespace Gemmule::Parameters
{
namespace
{
  bool is_order(const std::string &relation)
  {
    return relation != "==" && relation != "!=";
  }
} // namespace

void ExpressionComplaints::about_chain(const std::vector<ExpressionPart> &operands,
                                       const std::vector<std::string> &relations) const
{
  const auto pair = [&](const unsigned int i)
  { return text(operands[i]) + relations[i] + text(operands[i + 1]); };
  const bool only_numbers = std::none_of(operands.begin(), operands.end(),
                                         [](const ExpressionPart &operand) { return operand.is_truth; });
  std::string remedy = "Put each comparison into parentheses of its own.";
  if (relations.size() == 3 && only_numbers && is_order(relations[0]) && !is_order(relations[1]) &&
      is_order(relations[2]))
    remedy = "Write '(" + pair(0) + ")" + relations[1] + "(" + pair(2) + ")'.";
  else if (relations.size() == 2 && operands[2].is_truth && !is_order(relations[1]))
    remedy = "Write '(" + pair(0) + ")" + relations[1] + text(operands[2]) + "'.";
  else if (relations.size() == 2 && operands[0].is_truth && !is_order(relations[0]))
    remedy = "Write '" + text(operands[0]) + relations[0] + "(" + pair(1) + ")'.";
  else if (only_numbers)
  {
    remedy = "Write '" + pair(0);
    for (unsigned int i = 1; i < relations.size(); ++i)
      remedy += " && " + pair(i);
    remedy += "'.";
  }
  throw ExpressionError("compares more than two values at once in " +
                            quoted(operands.front(), operands.back()) + ": the result of '" + pair(0) +
                            "', which is true or false, would be compared with '" + text(operands[2]) + "'.",
                        remedy);
}

void ExpressionComplaints::about_comparison(const ExpressionPart &left, const std::string &relation,
                                            const ExpressionPart &right) const
{
  if (left.is_truth && right.is_truth)
    throw ExpressionError("compares two conditions by their size in " + quoted(left, right) + ".",
                          "Conditions are combined with && and ||, and compared with == and !=.");
  const ExpressionPart &condition = left.is_truth ? left : right, &number = left.is_truth ? right : left;
  const std::string complaint = "compares the condition " + quoted(condition) +
                                ", which is true or false, with the number " + quoted(number) + " in " +
                                quoted(left, right) + ".";
  const std::string value = inner_text(number);
  if (!is_order(relation) && (value == "0" || value == "1"))
  {
    const bool holds = (value == "1") == (relation == "==");
    throw ExpressionError(
        complaint, "Write '" + (holds ? inner_text(condition) : "!(" + inner_text(condition) + ")") + "'.");
  }
  if (condition.operands.empty() || condition.operands[0].is_truth)
    throw ExpressionError(complaint, "Compare two numbers, or combine conditions with && and ||.");
  const std::string inside = text(condition.operands[0]) + condition.relation + text(condition.operands[1]);
  throw ExpressionError(complaint, left.is_truth ? "Write '" + inside + " && " + text(condition.operands[1]) +
                                                       relation + text(right) + "'."
                                                 : "Write '" + text(left) + relation +
                                                       text(condition.operands[0]) + " && " + inside + "'.");
}

void ExpressionComplaints::about_combination(const ExpressionPart &left, const std::string &operation,
                                             const ExpressionPart &right) const
{
  const std::string where = "beside '" + operation + "'";
  // "x==1 || 2"
  if (!left.is_truth || left.operands.empty() || left.operands[0].is_truth || left.is_enclosed() ||
      is_order(left.relation))
    about_condition(left.is_truth ? right : left, where);
  throw ExpressionError("has the number " + quoted(right) + " where a condition is expected, " + where + ".",
                        "Write '" + text(left) + " " + operation + " " + text(left.operands[0]) +
                            left.relation + text(right) + "'.");
}

void ExpressionComplaints::about_arithmetic(const ExpressionPart &left, const std::string &operation,
                                            const ExpressionPart &right) const
{
  const ExpressionPart &condition = left.is_truth ? left : right, &other = left.is_truth ? right : left;
  std::string remedy = "Write " + as_number(condition) + " in the place of " + quoted(condition) + ".";
  if (operation == "*" && other.is_truth)
    remedy = "Write '" + text(left) + " && " + text(right) + "' for a condition, 'if(" + text(left) + " && " +
             text(right) + ", 1, 0)' for a number.";
  else if (operation == "*")
    remedy = "Write 'if(" + inner_text(condition) + ", " + inner_text(other) + ", 0)'.";
  throw ExpressionError("computes with the condition " + quoted(condition) +
                            ", which is true or false and no number, in " + quoted(left, right) + ".",
                        remedy);
}

void ExpressionComplaints::about_sign(const std::string &sign, const ExpressionPart &operand) const
{
  throw ExpressionError("has a sign in front of the condition " + quoted(operand) +
                            ", which is true or false and no number.",
                        "Write 'if(" + inner_text(operand) + ", " + (sign == "-" ? "-1" : "1") + ", 0)'.");
}

void ExpressionComplaints::about_argument(const std::string &function, const ExpressionPart &argument) const
{
  throw ExpressionError("gives the condition " + quoted(argument) + " to '" + function +
                            "', which takes numbers.",
                        "Write " + as_number(argument) + " in its place.");
}

void ExpressionComplaints::about_condition(const ExpressionPart &number, const std::string &where) const
{
  const std::string value = inner_text(number);
  const bool is_constant = value.find_first_not_of("0123456789.eE+- ") == std::string::npos;
  throw ExpressionError("has the number " + quoted(number) + " where a condition is expected, " + where + ".",
                        "Write a comparison, for example '" + (is_constant ? "x" : value) + ">0'.");
}

void ExpressionComplaints::about_negation(const ExpressionPart &number) const
{
  throw ExpressionError("has '!', which means 'not', in front of the number " + quoted(number) + ".",
                        "Put a comparison in parentheses behind it, for example '!(" + inner_text(number) +
                            ">0)'.");
}

void ExpressionComplaints::about_choice(const ExpressionPart &first, const ExpressionPart &second) const
{
  const ExpressionPart &condition = first.is_truth ? first : second;
  throw ExpressionError("chooses between a number and a condition, " + quoted(first) + " and " +
                            quoted(second) + ".",
                        "Write " + as_number(condition) + " in the place of " + quoted(condition) + ".");
}

void ExpressionComplaints::about_result(const ExpressionPart &whole) const
{
  std::string remedy = "Write " + as_number(whole) + " with the two numbers that are meant";
  if (!whole.operands.empty() && is_order(whole.relation) && !whole.operands[1].is_truth)
  {
    const std::string subtracted = text(whole.operands[1]);
    const bool is_sum = subtracted.find_first_of("+-") != std::string::npos;
    remedy += ", or '" + text(whole.operands[0]) + "-" + (is_sum ? "(" + subtracted + ")" : subtracted) +
              "' if its sign is";
  }
  throw ExpressionError("is a condition, true or false, and no number.", remedy + ".");
}

void ExpressionComplaints::about_number_of_arguments(const ExpressionFunction &function,
                                                     const unsigned int n) const
{
  const bool any_number = function.most_arguments > function.least_arguments;
  throw ExpressionError("gives " + std::to_string(n) + (n == 1 ? " argument" : " arguments") + " to '" +
                            function.name + "', which takes " + (any_number ? "at least " : "") +
                            std::to_string(function.least_arguments) + ".",
                        "Write '" + function.usage + "': " + function.meaning + ".");
}

std::string ExpressionComplaints::text(const ExpressionPart &part) const
{
  return printable(shortened(expression.substr(part.begin, part.end - part.begin)));
}

std::string ExpressionComplaints::inner_text(const ExpressionPart &part) const
{
  return printable(shortened(expression.substr(part.inner_begin, part.inner_end - part.inner_begin)));
}

std::string ExpressionComplaints::quoted(const ExpressionPart &first, const ExpressionPart &last) const
{
  return in_quotes(expression.substr(first.begin, last.end - first.begin));
}

std::string ExpressionComplaints::as_number(const ExpressionPart &condition) const
{
  return "'if(" + inner_text(condition) + ", 1, 0)'";
}
} // namespace Gemmule::Parameters
