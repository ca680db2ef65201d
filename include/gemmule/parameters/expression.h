// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/parameters/expression_tree.h>

#include <memory>
#include <string>
#include <vector>

namespace dealii
{
template <int dim, typename Number>
class Function;
template <int dim, typename Number>
class Point;
} // namespace dealii

namespace Gemmule
{
/**
 * Turns the text of a parameter into a function of x, y(, z) and the time t. A vector-valued function has its
 * components separated by ";". The names and operators are those of Parameters::expression_help(); the values
 * are computed by dealii::FunctionParser (muParser), after Parameters::checked_expression() has refused what
 * muParser would take for something else. The time is that of Function::set_time().
 *
 * @param expression the text
 * @param n_components number of components that it has to have
 * @param where full name of the parameter, for messages, for example "Membrane/Level set"
 * @param of_time whether t is known; an initial state has none
 * @throws ParameterError if the text cannot be parsed or has another number of components
 */
template <int dim>
std::unique_ptr<dealii::Function<dim, double>> make_function(const std::string &expression,
                                                             unsigned int n_components,
                                                             const std::string &where, bool of_time = true);

/**
 * The expression of an initial state that make_function() has taken, taken apart.
 * @throws Parameters::ExpressionError if make_function() would not take it
 */
template <int dim>
Parameters::ExpressionTree expression_tree(const std::string &expression);

/**
 * Evaluates all components of a function at the given points.
 * @return what is wrong with the first value that is not a finite number, with its point and time; nothing if
 * all are finite
 */
template <int dim>
std::string not_finite_complaint(const dealii::Function<dim, double> &function,
                                 const std::vector<dealii::Point<dim, double>> &points);

/**
 * Evaluates all components of a function at the given points.
 * @throws ParameterError naming @p where and the first point at which a value is not a finite number
 */
template <int dim>
void check_finite(const dealii::Function<dim, double> &function,
                  const std::vector<dealii::Point<dim, double>> &points, const std::string &where);
} // namespace Gemmule
