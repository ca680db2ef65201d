// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/parameters/expression_names.h>
#include <gemmule/parameters/expression_tokens.h>
#include <gemmule/parameters/expression_tree.h>

#include <string>
#include <vector>

namespace Gemmule::Parameters
{
/** A part of an expression: its kind, its place and what it computes. */
struct ExpressionPart
{
  ExpressionPart(const bool is_truth, const std::string::size_type begin, const std::string::size_type end,
                 const ExpressionTree &tree)
      : is_truth(is_truth), begin(begin), end(end), inner_begin(begin), inner_end(end), tree(tree)
  {
  }

  /** A condition, true or false, and no number? */
  bool is_truth;
  /** First byte, and that behind the last. */
  std::string::size_type begin, end;
  /** The same without the parentheses around it. */
  std::string::size_type inner_begin, inner_end;
  ExpressionTree tree;
  /** If it is a comparison: what is compared with what. */
  std::vector<ExpressionPart> operands;
  std::string relation;

  bool is_enclosed() const { return begin != inner_begin; }
};

/**
 * The messages about parts of an expression that do not fit together. Each says what is wrong in which part,
 * and what to write instead, in the user's own words. All members throw ExpressionError.
 */
class ExpressionComplaints
{
public:
  /** @param expression has to live as long as the object */
  explicit ExpressionComplaints(const std::string &expression) : expression(expression) {}

  /** a<b<c */
  [[noreturn]] void about_chain(const std::vector<ExpressionPart> &operands,
                                const std::vector<std::string> &relations) const;
  /** (a<b)<c */
  [[noreturn]] void about_comparison(const ExpressionPart &left, const std::string &relation,
                                     const ExpressionPart &right) const;
  /** a && b, where one of them is a number */
  [[noreturn]] void about_combination(const ExpressionPart &left, const std::string &operation,
                                      const ExpressionPart &right) const;
  /** (a<b)*c */
  [[noreturn]] void about_arithmetic(const ExpressionPart &left, const std::string &operation,
                                     const ExpressionPart &right) const;
  /** -(a<b) */
  [[noreturn]] void about_sign(const std::string &sign, const ExpressionPart &operand) const;
  /** sin(a<b) */
  [[noreturn]] void about_argument(const std::string &function, const ExpressionPart &argument) const;
  /** A number for a condition. @param where for example "in front of '?'" */
  [[noreturn]] void about_condition(const ExpressionPart &number, const std::string &where) const;
  /** !a */
  [[noreturn]] void about_negation(const ExpressionPart &number) const;
  /** if(a, b, c<d) */
  [[noreturn]] void about_choice(const ExpressionPart &first, const ExpressionPart &second) const;
  /** The whole is a condition. */
  [[noreturn]] void about_result(const ExpressionPart &whole) const;
  /** Too few or too many arguments. */
  [[noreturn]] void about_number_of_arguments(const ExpressionFunction &function, unsigned int n) const;

  /** The part as the user has written it. */
  std::string text(const ExpressionPart &part) const;
  /** The same without parentheses around it. */
  std::string inner_text(const ExpressionPart &part) const;
  /** From the beginning of the first to the end of the last, in quotes. */
  std::string quoted(const ExpressionPart &first, const ExpressionPart &last) const;
  std::string quoted(const ExpressionPart &part) const { return quoted(part, part); }

private:
  std::string as_number(const ExpressionPart &condition) const;

  const std::string &expression;
};
} // namespace Gemmule::Parameters
