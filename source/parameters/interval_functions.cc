// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/interval_functions.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <functional>
#include <map>

namespace Gemmule
{
namespace
{
  const double infinity = std::numeric_limits<double>::infinity();

  /** A function of one variable with its derivative, and where it has values. */
  struct Elementary
  {
    std::function<Interval(const Interval &)> value, derivative;
    Interval domain = everything();
    bool is_open = false; ///< do the ends of the domain not belong to it?

    bool is_defined_on(const Interval &x) const
    {
      return is_open ? x.lower() > domain.lower() && x.upper() < domain.upper()
                     : x.lower() >= domain.lower() && x.upper() <= domain.upper();
    }
  };

  /** A monotone function of the standard library at both ends. */
  template <typename Function>
  std::function<Interval(const Interval &)> increasing(const Function &function)
  {
    return [function](const Interval &x) { return Interval(function(x.lower()), function(x.upper())); };
  }

  /** One whose only jumps are steps between constants. */
  template <typename Function>
  Elementary staircase(const Function &function)
  {
    return {increasing(function), [function](const Interval &x)
            { return function(x.lower()) == function(x.upper()) ? Interval(0.) : everything(); }};
  }

  Interval whole_if_poles(const Interval &x)
  {
    return std::isinf(width(x)) ? everything() : x;
  }

  Interval cosecant(const Interval &x)
  {
    const Interval s = sin(x);
    return zero_in(s) ? everything() : Interval(1.) / s;
  }

  Interval secant(const Interval &x)
  {
    const Interval c = cos(x);
    return zero_in(c) ? everything() : Interval(1.) / c;
  }

  Interval inverse_root(const Interval &radicand) // 1 / sqrt(radicand), also at zero
  {
    const double low = std::max(radicand.lower(), 0.), high = std::max(radicand.upper(), 0.);
    return {1. / std::sqrt(high), low > 0. ? 1. / std::sqrt(low) : infinity};
  }

  Interval sign_of(const Interval &x)
  {
    const auto sign = [](const double t) { return t > 0. ? 1. : t < 0. ? -1. : 0.; };
    return {sign(x.lower()), sign(x.upper())};
  }

  const std::map<std::string, Elementary> &elementary_functions()
  {
    using dealii::numbers::PI;
    const auto logarithm = [](const double base)
    {
      const double factor = base == 0. ? 1. : 1. / std::log(base);
      return Elementary{[factor](const Interval &x) { return log(x) * factor; },
                        [factor](const Interval &x) { return Interval(factor) / x; }, Interval(0., infinity),
                        true};
    };
    const auto arcsine_derivative = [](const Interval &x) { return inverse_root(1. - square(x)); };
    const auto gauss = [](const double factor)
    { return [factor](const Interval &x) { return factor * exp(-square(x)); }; };
    static const std::map<std::string, Elementary> functions = {
        {"sin", {[](const Interval &x) { return sin(x); }, [](const Interval &x) { return cos(x); }}},
        {"cos", {[](const Interval &x) { return cos(x); }, [](const Interval &x) { return -sin(x); }}},
        {"tan",
         {[](const Interval &x) { return whole_if_poles(tan(x)); },
          [](const Interval &x) { return square(secant(x)); }}},
        {"cot",
         {[](const Interval &x) { return cos(x) * cosecant(x); },
          [](const Interval &x) { return -square(cosecant(x)); }}},
        {"sec", {secant, [](const Interval &x) { return secant(x) * tan(x); }}},
        {"csc", {cosecant, [](const Interval &x) { return -cos(x) * square(cosecant(x)); }}},
        {"asin",
         {increasing([](const double t) { return std::asin(t); }), arcsine_derivative, Interval(-1., 1.)}},
        {"acos",
         {[](const Interval &x) { return Interval(std::acos(x.upper()), std::acos(x.lower())); },
          [arcsine_derivative](const Interval &x) { return -arcsine_derivative(x); }, Interval(-1., 1.)}},
        {"atan",
         {increasing([](const double t) { return std::atan(t); }),
          [](const Interval &x) { return Interval(1.) / (1. + square(x)); }}},
        {"sinh",
         {increasing([](const double t) { return std::sinh(t); }),
          [](const Interval &x) { return cosh(x); }}},
        {"cosh",
         {[](const Interval &x) { return cosh(x); },
          increasing([](const double t) { return std::sinh(t); })}},
        {"tanh",
         {increasing([](const double t) { return std::tanh(t); }),
          [](const Interval &x)
          {
            const Interval c = cosh(x);
            return Interval(1. / std::pow(c.upper(), 2), 1. / std::pow(c.lower(), 2));
          }}},
        {"asinh",
         {increasing([](const double t) { return std::asinh(t); }),
          [](const Interval &x) { return inverse_root(1. + square(x)); }}},
        {"acosh",
         {increasing([](const double t) { return std::acosh(t); }),
          [](const Interval &x) { return inverse_root(square(x) - 1.); }, Interval(1., infinity)}},
        {"atanh",
         {increasing([](const double t) { return std::atanh(t); }),
          [](const Interval &x) { return Interval(1.) / (1. - square(x)); }, Interval(-1., 1.), true}},
        {"exp",
         {increasing([](const double t) { return std::exp(t); }),
          increasing([](const double t) { return std::exp(t); })}},
        {"log", logarithm(0.)},
        {"ln", logarithm(0.)},
        {"log2", logarithm(2.)},
        {"log10", logarithm(10.)},
        {"sqrt",
         {increasing([](const double t) { return std::sqrt(t); }),
          [](const Interval &x) { return 0.5 * inverse_root(x); }, Interval(0., infinity)}},
        {"abs", {[](const Interval &x) { return abs(x); }, sign_of}},
        {"erfc",
         {[](const Interval &x) { return Interval(std::erfc(x.upper()), std::erfc(x.lower())); },
          gauss(-2. / std::sqrt(PI))}},
        {"sign", staircase([](const double t) { return t > 0.   ? 1.
                                                       : t < 0. ? -1.
                                                                : 0.; })},
        {"rint", staircase([](const double t) { return std::floor(t + 0.5); })},
        {"floor", staircase([](const double t) { return std::floor(t); })},
        {"ceil", staircase([](const double t) { return std::ceil(t); })},
    };
    return functions;
  }

  /** The smaller or the larger one of two. */
  template <int dim>
  IntervalJet<dim> extremum(const IntervalJet<dim> &a, const IntervalJet<dim> &b, const bool largest)
  {
    const IntervalJet<dim> &low = a.value.upper() < b.value.upper() ? a : b;
    const IntervalJet<dim> &high = &low == &a ? b : a;
    IntervalJet<dim> result =
        low.value.upper() < high.value.lower() ? (largest ? high : low) : either(a, b, /*may_jump =*/false);
    result.value = largest ? max(a.value, b.value) : min(a.value, b.value);
    result.is_defined = a.is_defined && b.is_defined;
    return result;
  }

  template <int dim>
  IntervalJet<dim> arctangent(const IntervalJet<dim> &y, const IntervalJet<dim> &x)
  {
    using dealii::numbers::PI;
    // The jump on the negative x axis, and the origin.
    if (zero_in(y.value) && x.value.lower() <= 0.)
    {
      auto result = IntervalJet<dim>::unknown(x.is_defined && y.is_defined);
      result.value = Interval(-PI, PI);
      return result;
    }
    double low = PI, high = -PI;
    for (const double a : {y.value.lower(), y.value.upper()})
      for (const double b : {x.value.lower(), x.value.upper()})
      {
        low = std::min(low, std::atan2(a, b));
        high = std::max(high, std::atan2(a, b));
      }
    IntervalJet<dim> result;
    result.value = sound(Interval(low, high));
    const Interval square_of_radius = square(x.value) + square(y.value);
    for (unsigned int d = 0; d < dim; ++d)
      result.derivative[d] =
          sound((x.value * y.derivative[d] - y.value * x.derivative[d]) / square_of_radius);
    result.is_defined = x.is_defined && y.is_defined;
    return result;
  }
} // namespace

template <int dim>
IntervalJet<dim> interval_power(const IntervalJet<dim> &base, const IntervalJet<dim> &exponent)
{
  const bool is_constant = exponent.value.lower() == exponent.value.upper();
  const double n = exponent.value.lower();
  if (is_constant && n == std::floor(n) && std::abs(n) <= 100.)
  {
    const int power = static_cast<int>(n);
    if (power == 0)
      return IntervalJet<dim>::constant(1.);
    if (power < 0)
      return reciprocal(interval_power(base, IntervalJet<dim>::constant(-n)));
    return chain(base, pow(base.value, power), n * (power == 1 ? Interval(1.) : pow(base.value, power - 1)));
  }
  if (is_constant && n > 0. && base.value.lower() >= 0.)
  {
    const double low = std::pow(base.value.lower(), n), high = std::pow(base.value.upper(), n);
    const double slopes[2] = {n * std::pow(base.value.lower(), n - 1.),
                              n * std::pow(base.value.upper(), n - 1.)};
    return chain(base, Interval(low, high),
                 sound(Interval(std::min(slopes[0], slopes[1]), std::max(slopes[0], slopes[1]))));
  }
  if (!(base.value.lower() > 0.))
    return IntervalJet<dim>::unknown(false);
  static const IntervalFunction<dim> exponential = interval_function<dim>("exp"),
                                     logarithm = interval_function<dim>("log");
  return exponential({exponent * logarithm({base})});
}

template <int dim>
IntervalFunction<dim> interval_function(const std::string &name)
{
  using Jets = std::vector<IntervalJet<dim>>;
  const auto &known = elementary_functions();
  if (const auto found = known.find(name); found != known.end())
    return [&function = found->second](const Jets &x)
    {
      // Outside of its domain a function may be anything, and a box may have a part there.
      if (!function.is_defined_on(x[0].value))
        return IntervalJet<dim>::unknown(false);
      return chain(x[0], function.value(x[0].value), function.derivative(x[0].value));
    };
  if (name == "min" || name == "max")
    return [largest = name == "max"](const Jets &x)
    {
      IntervalJet<dim> result = x[0];
      for (unsigned int i = 1; i < x.size(); ++i)
        result = extremum(result, x[i], largest);
      return result;
    };
  if (name == "sum" || name == "avg")
    return [is_sum = name == "sum"](const Jets &x)
    {
      IntervalJet<dim> result = x[0];
      for (unsigned int i = 1; i < x.size(); ++i)
        result = result + x[i];
      return is_sum ? result : result * IntervalJet<dim>::constant(1. / x.size());
    };
  if (name == "atan2")
    return [](const Jets &x) { return arctangent(x[0], x[1]); };
  if (name == "pow")
    return [](const Jets &x) { return interval_power(x[0], x[1]); };
  return [](const Jets &) { return IntervalJet<dim>::unknown(false); };
}

template IntervalFunction<2> interval_function<2>(const std::string &);
template IntervalFunction<3> interval_function<3>(const std::string &);
template IntervalJet<2> interval_power(const IntervalJet<2> &, const IntervalJet<2> &);
template IntervalJet<3> interval_power(const IntervalJet<3> &, const IntervalJet<3> &);
} // namespace Gemmule
