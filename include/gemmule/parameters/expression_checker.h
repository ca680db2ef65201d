#pragma once

#include <gemmule/parameters/expression_names.h>
#include <gemmule/parameters/expression_tokens.h>

#include <string>

namespace Gemmule::Parameters
{
/**
 * Checks that an expression means what it says. muParser, which evaluates it, knows numbers only: it takes
 * -1<x<1 for (-1<x)<1, rounds a number where a condition is expected, and assigns with '='. Here every part
 * is a number or a truth value, and each operator and function gets what it is made for: arithmetic and
 * functions take numbers, && || ! and conditions take truth values, comparisons take two numbers, == and !=
 * also two truth values. The result is a number.
 *
 * @param expression one component, without ';'
 * @return the same expression for muParser, which knows no '!' and needs blanks around '&&' and '||'
 * @throws ExpressionError
 */
std::string checked_expression(const std::string &expression, const ExpressionScope &scope);
} // namespace Gemmule::Parameters
