// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/parameters/expression_complaints.h>
#include <gemmule/parameters/expression_names.h>
#include <gemmule/parameters/expression_tokens.h>

#include <string>
#include <vector>

namespace Gemmule::Parameters
{
/**
 * The messages about tokens of an expression that cannot stand where they do, or are missing there. Tokens
 * are named by their number. All members but place() throw ExpressionError.
 */
class SyntaxComplaints
{
public:
  /** The arguments have to live as long as the object. */
  SyntaxComplaints(const std::vector<ExpressionToken> &tokens, const ExpressionScope &scope,
                   const ExpressionComplaints &parts)
      : tokens(tokens), scope(scope), parts(parts)
  {
  }

  /** Neither number nor name nor parenthesis, where an operand begins. */
  [[noreturn]] void about_missing_operand(unsigned int token) const;
  /** What is left behind a complete expression. */
  [[noreturn]] void about_rest(unsigned int token) const;
  /** a ? b */
  [[noreturn]] void about_choice_without_end(unsigned int token) const;
  /** - -a */
  [[noreturn]] void about_two_signs(unsigned int token) const;
  /** a^1/2 @param token the 1 */
  [[noreturn]] void about_root(const ExpressionPart &base, unsigned int token) const;
  /** a! */
  [[noreturn]] void about_factorial(const ExpressionPart &part) const;
  /** () */
  [[noreturn]] void about_empty_parentheses(unsigned int opening) const;
  /** (a, b) */
  [[noreturn]] void about_comma(unsigned int token) const;
  /** (a */
  [[noreturn]] void about_open_parenthesis(unsigned int opening) const;
  /** sin a */
  [[noreturn]] void about_missing_argument(const ExpressionFunction &function, unsigned int token) const;
  /** A name that is neither a quantity nor a function. */
  [[noreturn]] void about_unknown_name(unsigned int token) const;
  /** a b. @param token the first one behind @p part */
  [[noreturn]] void about_missing_operator(const ExpressionPart &part, unsigned int token) const;

private:
  /** 2 x @param complaint what is wrong, complete */
  [[noreturn]] void about_forgotten_product(const ExpressionPart &part, unsigned int token,
                                            const std::string &complaint) const;
  std::string place(unsigned int token) const;

  const std::vector<ExpressionToken> &tokens;
  const ExpressionScope &scope;
  const ExpressionComplaints &parts;
};
} // namespace Gemmule::Parameters
