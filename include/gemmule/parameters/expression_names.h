// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace Gemmule::Parameters
{
/** A function that expressions may call. */
struct ExpressionFunction
{
  std::string name;
  /** How it is called, for example "atan2(y, x)". */
  std::string usage;
  std::string meaning;
  unsigned int least_arguments = 1;
  unsigned int most_arguments = 1;
  /** Is the first argument a condition, as that of 'if'? */
  bool has_condition = false;
};

/** A number that expressions may call by its name. */
struct ExpressionConstant
{
  std::string name;
  double value;
  std::string meaning;
};

/** Operators that bind equally strongly. */
struct ExpressionOperator
{
  std::string symbols;
  std::string meaning;
};

/** Where an expression is evaluated: which variables it has. */
struct ExpressionScope
{
  /** 2: x and y, 3: x, y and z. */
  unsigned int dimension = 2;
  /** Is the time t known? An initial state has none. */
  bool of_time = true;

  std::vector<std::string> variables() const;
  /** Is that the name of a variable or a constant? */
  bool has_quantity(const std::string &name) const;
};

/** All functions, constants and operators, in the order of their explanation. */
const std::vector<ExpressionFunction> &expression_functions();
const std::vector<ExpressionConstant> &expression_constants();
/** From the strongest to the weakest. */
const std::vector<ExpressionOperator> &expression_operators();

/** The function of that name, or a null pointer. */
const ExpressionFunction *find_expression_function(const std::string &name);

/**
 * What to write instead of a name that is not known, as sentences.
 * @param is_called whether arguments in parentheses follow it
 */
std::string remedy_for_unknown_name(const std::string &name, bool is_called, const ExpressionScope &scope);

/** The variables, functions, constants and operators with their meaning, as 'gemmule --help-expressions'
 * prints them. */
std::string expression_help();
} // namespace Gemmule::Parameters
