// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace Gemmule::Parameters
{
/** Why an expression is refused. */
class ExpressionError : public std::runtime_error
{
public:
  /**
   * @param complaint goes on after "the expression '...' ", ends with a full stop
   * @param remedy what to write instead, as sentences; empty if the complaint leaves that open
   */
  ExpressionError(const std::string &complaint, const std::string &remedy)
      : std::runtime_error(remedy.empty() ? complaint : complaint + " " + remedy), has_remedy(!remedy.empty())
  {
  }

  const bool has_remedy;
};

/** A word of an expression. */
struct ExpressionToken
{
  enum Kind
  {
    number,
    name,
    operation,
    opening_parenthesis,
    closing_parenthesis,
    comma,
    end
  };

  Kind kind;
  std::string text;
  /** First byte in the expression. */
  std::string::size_type position;

  std::string::size_type behind() const { return position + text.size(); }
  bool is(const std::string &operation_) const { return kind == operation && text == operation_; }
};

/**
 * Divides an expression into its words; the last one is of the kind 'end'.
 * @throws ExpressionError about characters, numbers and operators that do not exist
 */
std::vector<ExpressionToken> expression_tokens(const std::string &expression);
} // namespace Gemmule::Parameters
