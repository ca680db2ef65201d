// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/parameters/expression_names.h>
#include <gemmule/parameters/expression_tokens.h>
#include <gemmule/parameters/expression_tree.h>

#include <string>

namespace Gemmule::Parameters
{
/** An expression that means what it says. */
struct CheckedExpression
{
  /** For muParser, which knows no '!' and needs blanks around '&&' and '||'. */
  std::string text;
  /** The same, taken apart. */
  ExpressionTree tree;
};

/**
 * Checks that an expression means what it says. muParser, which evaluates it, knows numbers only: it takes
 * -1<x<1 for (-1<x)<1, rounds a number where a condition is expected, and assigns with '='. Here every part
 * is a number or a truth value, and each operator and function gets what it is made for: arithmetic and
 * functions take numbers, && || ! and conditions take truth values, comparisons take two numbers, == and !=
 * also two truth values. The result is a number.
 *
 * @param expression one component, without ';'
 * @throws ExpressionError
 */
CheckedExpression checked_expression(const std::string &expression, const ExpressionScope &scope);
} // namespace Gemmule::Parameters
