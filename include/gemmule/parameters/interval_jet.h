// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <boost/numeric/interval.hpp>
#include <cmath>
#include <limits>

namespace Gemmule
{
/** Bounds of a number, up to round-off: the arithmetic is not rounded outwards. */
using Interval = boost::numeric::interval<
    double,
    boost::numeric::interval_lib::policies<boost::numeric::interval_lib::save_state_nothing<
                                               boost::numeric::interval_lib::rounded_transc_exact<double>>,
                                           boost::numeric::interval_lib::checking_base<double>>>;

/** Any number. */
inline Interval everything()
{
  return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
}

/** @p x, or any number where an operation on infinite bounds has given none. */
inline Interval sound(const Interval &x)
{
  return std::isnan(x.lower()) || std::isnan(x.upper()) ? everything() : x;
}

/** Bounds of a function and of its partial derivatives on a box: forward differentiation of intervals. */
template <int dim>
struct IntervalJet
{
  Interval value = 0.;
  std::array<Interval, dim> derivative{};
  bool is_defined = true; ///< is every value in the box a finite number, as far as one can tell?

  static IntervalJet constant(const double number)
  {
    IntervalJet jet;
    jet.value = number;
    return jet;
  }

  static IntervalJet variable(const Interval &range, const unsigned int d)
  {
    IntervalJet jet;
    jet.value = range;
    jet.derivative[d] = 1.;
    return jet;
  }

  /** Of which nothing is known. */
  static IntervalJet unknown(const bool is_defined)
  {
    IntervalJet jet;
    jet.value = everything();
    jet.derivative.fill(everything());
    jet.is_defined = is_defined;
    return jet;
  }
};

/** f(x) for a function of one variable with the given bounds of value and derivative (chain rule). */
template <int dim>
IntervalJet<dim> chain(const IntervalJet<dim> &x, const Interval &value, const Interval &derivative,
                       const bool is_defined = true)
{
  IntervalJet<dim> result;
  result.value = sound(value);
  for (unsigned int d = 0; d < dim; ++d)
    result.derivative[d] = sound(derivative * x.derivative[d]);
  result.is_defined = x.is_defined && is_defined;
  return result;
}

template <int dim>
IntervalJet<dim> operator+(const IntervalJet<dim> &a, const IntervalJet<dim> &b)
{
  IntervalJet<dim> result;
  result.value = sound(a.value + b.value);
  for (unsigned int d = 0; d < dim; ++d)
    result.derivative[d] = sound(a.derivative[d] + b.derivative[d]);
  result.is_defined = a.is_defined && b.is_defined;
  return result;
}

template <int dim>
IntervalJet<dim> operator-(const IntervalJet<dim> &a)
{
  return chain(a, -a.value, Interval(-1.));
}

template <int dim>
IntervalJet<dim> operator-(const IntervalJet<dim> &a, const IntervalJet<dim> &b)
{
  return a + (-b);
}

template <int dim>
IntervalJet<dim> operator*(const IntervalJet<dim> &a, const IntervalJet<dim> &b)
{
  IntervalJet<dim> result;
  result.value = sound(a.value * b.value);
  for (unsigned int d = 0; d < dim; ++d)
    result.derivative[d] = sound(a.derivative[d] * b.value + a.value * b.derivative[d]);
  result.is_defined = a.is_defined && b.is_defined;
  return result;
}

template <int dim>
IntervalJet<dim> reciprocal(const IntervalJet<dim> &a)
{
  if (zero_in(a.value))
    return IntervalJet<dim>::unknown(false);
  return chain(a, Interval(1.) / a.value, -Interval(1.) / square(a.value));
}

template <int dim>
IntervalJet<dim> operator/(const IntervalJet<dim> &a, const IntervalJet<dim> &b)
{
  return a * reciprocal(b);
}

/** Bounds that hold for both. With @p may_jump from one to the other nothing is known of the derivatives. */
template <int dim>
IntervalJet<dim> either(const IntervalJet<dim> &a, const IntervalJet<dim> &b, const bool may_jump)
{
  IntervalJet<dim> result;
  result.value = hull(a.value, b.value);
  for (unsigned int d = 0; d < dim; ++d)
    result.derivative[d] = may_jump ? everything() : hull(a.derivative[d], b.derivative[d]);
  result.is_defined = a.is_defined && b.is_defined;
  return result;
}
} // namespace Gemmule
