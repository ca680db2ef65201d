// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <gemmule/parameters/interval_jet.h>

#include <functional>
#include <string>
#include <vector>

namespace Gemmule
{
/** Bounds of a function of one or several numbers. */
template <int dim>
using IntervalFunction = std::function<IntervalJet<dim>(const std::vector<IntervalJet<dim>> &)>;

/** The function of expressions with that name; one of which nothing is known may have any value. */
template <int dim>
IntervalFunction<dim> interval_function(const std::string &name);

/** Bounds of base^exponent. */
template <int dim>
IntervalJet<dim> interval_power(const IntervalJet<dim> &base, const IntervalJet<dim> &exponent);
} // namespace Gemmule
