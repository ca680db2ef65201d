// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/expression_bounds.h>
#include <gemmule/parameters/interval_functions.h>

#include <deal.II/base/exceptions.h>

#include <functional>

namespace Gemmule
{
using namespace dealii;
using Parameters::ExpressionNode;

namespace
{
  /** What is known of a condition on a box. */
  enum class Truth
  {
    nowhere,
    everywhere,
    undecided
  };

  Truth opposite(const Truth a)
  {
    return a == Truth::undecided ? a : a == Truth::nowhere ? Truth::everywhere : Truth::nowhere;
  }

  Truth conjunction(const Truth a, const Truth b)
  {
    if (a == Truth::nowhere || b == Truth::nowhere)
      return Truth::nowhere;
    return a == Truth::everywhere && b == Truth::everywhere ? Truth::everywhere : Truth::undecided;
  }

  Truth same(const Truth a, const Truth b)
  {
    if (a == Truth::undecided || b == Truth::undecided)
      return Truth::undecided;
    return a == b ? Truth::everywhere : Truth::nowhere;
  }

  Truth is_less(const Interval &a, const Interval &b, const bool or_equal)
  {
    if (or_equal ? a.upper() <= b.lower() : a.upper() < b.lower())
      return Truth::everywhere;
    if (or_equal ? a.lower() > b.upper() : a.lower() >= b.upper())
      return Truth::nowhere;
    return Truth::undecided;
  }

  Truth is_equal(const Interval &a, const Interval &b)
  {
    if (a.upper() < b.lower() || b.upper() < a.lower())
      return Truth::nowhere;
    return width(a) == 0. && width(b) == 0. ? Truth::everywhere : Truth::undecided;
  }

  bool is_condition(const ExpressionNode &node)
  {
    if (node.kind == ExpressionNode::Kind::conditional)
      return is_condition(*node.arguments[1]);
    return node.kind == ExpressionNode::Kind::operation &&
           std::string("<>=!&|").find(node.name[0]) != std::string::npos;
  }
} // namespace

/** The tree as functions of a box, so that names are looked up once. */
template <int dim>
class ExpressionBounds<dim>::Evaluation
{
public:
  using Box = std::array<Interval, dim>;
  using Jet = IntervalJet<dim>;
  using Number = std::function<Jet(const Box &)>;
  using Condition = std::function<Truth(const Box &)>;

  explicit Evaluation(const ExpressionNode &expression) : value(number(expression)) {}

  const Number value;

private:
  static Number number(const ExpressionNode &node)
  {
    using Kind = ExpressionNode::Kind;
    switch (node.kind)
    {
    case Kind::number:
      return [jet = Jet::constant(node.number)](const Box &) { return jet; };
    case Kind::variable:
      return variable(node.name);
    case Kind::conditional:
      return conditional(node);
    case Kind::function:
      return function(interval_function<dim>(node.name), node.arguments);
    case Kind::operation:
      break;
    }
    const Number a = number(*node.arguments[0]);
    if (node.arguments.size() == 1)
      return node.name == "-" ? [a](const Box &box) { return -a(box); } : a;
    const Number b = number(*node.arguments[1]);
    switch (node.name[0])
    {
    case '+':
      return [a, b](const Box &box) { return a(box) + b(box); };
    case '-':
      return [a, b](const Box &box) { return a(box) - b(box); };
    case '*':
      return [a, b](const Box &box) { return a(box) * b(box); };
    case '/':
      return [a, b](const Box &box) { return a(box) / b(box); };
    default:
      AssertThrow(node.name == "^", ExcInternalError());
      return [a, b](const Box &box) { return interval_power(a(box), b(box)); };
    }
  }

  static Number variable(const std::string &name)
  {
    const unsigned int d = name == "x" ? 0 : name == "y" ? 1 : name == "z" ? 2 : dim;
    if (d >= dim)
      return [](const Box &) { return Jet::unknown(true); };
    return [d](const Box &box) { return Jet::variable(box[d], d); };
  }

  static Number function(const IntervalFunction<dim> &function,
                         const std::vector<Parameters::ExpressionTree> &arguments)
  {
    std::vector<Number> numbers;
    for (const auto &argument : arguments)
      numbers.push_back(number(*argument));
    return [function, numbers](const Box &box)
    {
      std::vector<Jet> jets;
      jets.reserve(numbers.size());
      for (const Number &argument : numbers)
        jets.push_back(argument(box));
      return function(jets);
    };
  }

  static Number conditional(const ExpressionNode &node)
  {
    const Condition holds = condition(*node.arguments[0]);
    const Number a = number(*node.arguments[1]), b = number(*node.arguments[2]);
    return [holds, a, b](const Box &box)
    {
      const Truth truth = holds(box);
      return truth == Truth::everywhere ? a(box)
             : truth == Truth::nowhere  ? b(box)
                                        : either(a(box), b(box), /*may_jump =*/true);
    };
  }

  static Condition condition(const ExpressionNode &node)
  {
    if (node.kind == ExpressionNode::Kind::conditional)
    {
      const Condition holds = condition(*node.arguments[0]), a = condition(*node.arguments[1]),
                      b = condition(*node.arguments[2]);
      return [holds, a, b](const Box &box)
      {
        const Truth truth = holds(box), first = a(box), second = b(box);
        return truth == Truth::everywhere ? first
               : truth == Truth::nowhere  ? second
               : first == second          ? first
                                          : Truth::undecided;
      };
    }
    const std::string &name = node.name;
    if (name == "!")
      return [a = condition(*node.arguments[0])](const Box &box) { return opposite(a(box)); };
    if (is_condition(*node.arguments[0]))
      return combination(name, condition(*node.arguments[0]), condition(*node.arguments[1]));
    return comparison(name, number(*node.arguments[0]), number(*node.arguments[1]));
  }

  static Condition combination(const std::string &name, const Condition &a, const Condition &b)
  {
    if (name == "&&")
      return [a, b](const Box &box) { return conjunction(a(box), b(box)); };
    if (name == "||")
      return [a, b](const Box &box) { return opposite(conjunction(opposite(a(box)), opposite(b(box)))); };
    if (name == "==")
      return [a, b](const Box &box) { return same(a(box), b(box)); };
    return [a, b](const Box &box) { return opposite(same(a(box), b(box))); };
  }

  static Condition comparison(const std::string &name, const Number &a, const Number &b)
  {
    if (name[0] == '<')
      return [a, b, or_equal = name == "<="](const Box &box)
      { return is_less(a(box).value, b(box).value, or_equal); };
    if (name[0] == '>')
      return [a, b, or_equal = name == ">="](const Box &box)
      { return is_less(b(box).value, a(box).value, or_equal); };
    if (name == "==")
      return [a, b](const Box &box) { return is_equal(a(box).value, b(box).value); };
    return [a, b](const Box &box) { return opposite(is_equal(a(box).value, b(box).value)); };
  }
};

template <int dim>
ExpressionBounds<dim>::ExpressionBounds(const ExpressionNode &expression)
    : evaluation(std::make_unique<Evaluation>(expression))
{
}

template <int dim>
ExpressionBounds<dim>::~ExpressionBounds() = default;

template <int dim>
FunctionBounds<dim> ExpressionBounds<dim>::on_cube(const Point<dim> &corner, const double size) const
{
  typename Evaluation::Box box;
  for (unsigned int d = 0; d < dim; ++d)
    box[d] = Interval(corner[d], corner[d] + size);
  const IntervalJet<dim> jet = evaluation->value(box);
  FunctionBounds<dim> bounds;
  // Round-off of the operations, which are not rounded outwards.
  constexpr double round_off = 1e-13;
  const double margin = round_off * std::max(std::abs(jet.value.lower()), std::abs(jet.value.upper()));
  bounds.lower = jet.value.lower() - margin;
  bounds.upper = jet.value.upper() + margin;
  bounds.is_defined = jet.is_defined;
  for (unsigned int d = 0; d < dim; ++d)
  {
    bounds.lower_derivative[d] = jet.derivative[d].lower();
    bounds.upper_derivative[d] = jet.derivative[d].upper();
  }
  return bounds;
}

template class ExpressionBounds<2>;
template class ExpressionBounds<3>;
} // namespace Gemmule
