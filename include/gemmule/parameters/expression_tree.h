// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace Gemmule::Parameters
{
struct ExpressionNode;
/** An expression taken apart. Parts that do not change may be shared. */
using ExpressionTree = std::shared_ptr<const ExpressionNode>;

/** A part of an expression with the parts that it is made of. */
struct ExpressionNode
{
  enum class Kind
  {
    number,      ///< of the value `number`; constants are numbers, too
    variable,    ///< `name` is x, y, z or t
    operation,   ///< `name` is one of + - * / ^ < <= > >= == != && || ! with one (sign, not) or two arguments
    conditional, ///< condition, value where it holds, value elsewhere
    function     ///< `name` is one of expression_functions(), but not 'if'
  };

  ExpressionNode(const double number) : kind(Kind::number), number(number) {}
  ExpressionNode(const Kind kind, const std::string &name, const std::vector<ExpressionTree> &arguments)
      : kind(kind), name(name), number(0.), arguments(arguments)
  {
  }

  const Kind kind;
  const std::string name;
  const double number;
  const std::vector<ExpressionTree> arguments;
};
} // namespace Gemmule::Parameters
