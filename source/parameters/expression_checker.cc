// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/expression_checker.h>
#include <gemmule/parameters/expression_complaints.h>
#include <gemmule/parameters/expression_syntax_complaints.h>

namespace Gemmule::Parameters
{
namespace
{
  using Part = ExpressionPart;
  using Token = ExpressionToken;
  using Kind = ExpressionNode::Kind;

  // Deeper ones are no formulas, and each level takes some of the stack.
  constexpr unsigned int deepest = 600;
  // muParser takes 20000.
  constexpr std::string::size_type longest = 10000;

  /** Counts how deep parts are nested, and refuses what is too deep. */
  class Level
  {
  public:
    explicit Level(unsigned int &depth) : depth(depth)
    {
      if (++depth > deepest)
        throw ExpressionError("is nested too deeply.", "Write it with fewer parentheses within each other.");
    }
    ~Level() { --depth; }
    Level(const Level &) = delete;
    Level &operator=(const Level &) = delete;

  private:
    unsigned int &depth;
  };

  /**
   * Recursive descent with one function for each strength of operators, as they are in muParser. It computes
   * kinds and places of the parts instead of values.
   */
  class Checker
  {
  public:
    Checker(const std::string &expression, const ExpressionScope &scope)
        : scope(scope), tokens(expression_tokens(expression)), complaints(expression),
          syntax(tokens, scope, complaints)
    {
      // muParser's own _pi has twelve digits.
      for (const Token &token : tokens)
        written.push_back(token.is("&&") || token.is("||") ? " " + token.text + " "
                          : token.text == "_pi"            ? "pi"
                                                           : token.text);
    }

    CheckedExpression run()
    {
      const Part whole = conditional();
      if (here().kind != Token::end)
        syntax.about_rest(next);
      if (whole.is_truth)
        complaints.about_result(whole);
      CheckedExpression result;
      for (const std::string &word : written)
        result.text += word;
      result.tree = whole.tree;
      return result;
    }

  private:
    Part conditional()
    {
      const Level level(depth);
      const Part condition = disjunction();
      if (!here().is("?"))
        return condition;
      if (!condition.is_truth)
        complaints.about_condition(condition, "in front of '?'");
      ++next;
      const Part first = conditional();
      if (!here().is(":"))
        syntax.about_choice_without_end(next);
      ++next;
      const Part second = conditional();
      if (first.is_truth != second.is_truth)
        complaints.about_choice(first, second);
      return Part(first.is_truth, condition.begin, second.end,
                  node(Kind::conditional, "", {condition, first, second}));
    }

    Part disjunction()
    {
      Part left = conjunction();
      while (here().is("||"))
      {
        ++next;
        left = combined(left, "||", conjunction());
      }
      return left;
    }

    Part conjunction()
    {
      Part left = comparison();
      while (here().is("&&"))
      {
        ++next;
        left = combined(left, "&&", comparison());
      }
      return left;
    }

    Part combined(const Part &left, const std::string &operation, const Part &right) const
    {
      if (!left.is_truth || !right.is_truth)
        complaints.about_combination(left, operation, right);
      return Part(true, left.begin, right.end, node(Kind::operation, operation, {left, right}));
    }

    Part comparison()
    {
      const Part first = sum();
      std::vector<Part> operands{first};
      std::vector<std::string> relations;
      while (is_relation(here()))
      {
        relations.push_back(tokens[next++].text);
        operands.push_back(sum());
      }
      if (relations.empty())
        return first;
      if (relations.size() > 1)
        complaints.about_chain(operands, relations);
      const bool is_order = relations[0] != "==" && relations[0] != "!=";
      if (operands[0].is_truth != operands[1].is_truth || (operands[0].is_truth && is_order))
        complaints.about_comparison(operands[0], relations[0], operands[1]);
      Part result(true, operands[0].begin, operands[1].end, node(Kind::operation, relations[0], operands));
      result.operands = operands;
      result.relation = relations[0];
      return result;
    }

    static bool is_relation(const Token &token)
    {
      return token.kind == Token::operation &&
             (token.text[0] == '<' || token.text[0] == '>' || token.text == "==" || token.text == "!=");
    }

    Part sum()
    {
      Part left = product();
      while (here().is("+") || here().is("-"))
      {
        const std::string operation = tokens[next++].text;
        left = computed(left, operation, product());
      }
      return left;
    }

    Part product()
    {
      Part left = sign();
      while (here().is("*") || here().is("/"))
      {
        const std::string operation = tokens[next++].text;
        left = computed(left, operation, sign());
      }
      return left;
    }

    Part sign()
    {
      const Level level(depth);
      if (!here().is("-") && !here().is("+"))
        return power();
      const Token &operation = tokens[next++];
      if (here().is("-") || here().is("+"))
        syntax.about_two_signs(next);
      const Part operand = power();
      if (operand.is_truth)
        complaints.about_sign(operation.text, operand);
      return Part(false, operation.position, operand.end, node(Kind::operation, operation.text, {operand}));
    }

    Part power()
    {
      const Part base = primary();
      if (!here().is("^"))
        return base;
      ++next;
      if (here().kind == Token::number && here().text == "1" && tokens[next + 1].is("/"))
        syntax.about_root(base, next);
      return computed(base, "^", sign());
    }

    Part computed(const Part &left, const std::string &operation, const Part &right) const
    {
      if (left.is_truth || right.is_truth)
        complaints.about_arithmetic(left, operation, right);
      return Part(false, left.begin, right.end, node(Kind::operation, operation, {left, right}));
    }

    Part primary()
    {
      const Level level(depth);
      const Token &token = here();
      if (token.kind != Token::number && token.kind != Token::name &&
          token.kind != Token::opening_parenthesis && !token.is("!"))
        syntax.about_missing_operand(next);
      const Part result = token.kind == Token::number ? number()
                          : token.kind == Token::name ? named()
                          : token.is("!")             ? negation()
                                                      : enclosed();
      if (here().is("!"))
        syntax.about_factorial(result);
      if (here().kind == Token::number || here().kind == Token::name ||
          here().kind == Token::opening_parenthesis)
        syntax.about_missing_operator(result, next);
      return result;
    }

    Part number()
    {
      const Token &token = tokens[next++];
      return Part(false, token.position, token.behind(),
                  std::make_shared<ExpressionNode>(std::stod(token.text)));
    }

    Part enclosed()
    {
      const unsigned int opening = next++;
      if (here().kind == Token::closing_parenthesis)
        syntax.about_empty_parentheses(opening);
      Part result = conditional();
      if (here().kind == Token::comma)
        syntax.about_comma(next);
      close(opening);
      result.begin = tokens[opening].position;
      result.end = tokens[next - 1].behind();
      return result;
    }

    void close(const unsigned int opening)
    {
      if (here().kind != Token::closing_parenthesis)
        syntax.about_open_parenthesis(opening);
      ++next;
    }

    /** muParser has no '!': instead of !(c) it gets ((c)==0). */
    Part negation()
    {
      const unsigned int mark = next++;
      const Part operand = primary();
      if (!operand.is_truth)
        complaints.about_negation(operand);
      written[mark] = "(";
      written[next - 1] += "==0)";
      return Part(true, tokens[mark].position, operand.end, node(Kind::operation, "!", {operand}));
    }

    Part named()
    {
      const unsigned int mark = next++;
      const Token &token = tokens[mark];
      if (scope.has_quantity(token.text))
        return Part(false, token.position, token.behind(), quantity(token.text));
      const ExpressionFunction *const function = find_expression_function(token.text);
      if (function == nullptr)
        syntax.about_unknown_name(mark);
      if (here().kind != Token::opening_parenthesis)
        syntax.about_missing_argument(*function, mark);
      return call(*function, token);
    }

    Part call(const ExpressionFunction &function, const Token &token)
    {
      const unsigned int opening = next++;
      std::vector<Part> arguments;
      if (here().kind != Token::closing_parenthesis)
        arguments.push_back(conditional());
      while (here().kind == Token::comma)
      {
        ++next;
        arguments.push_back(conditional());
      }
      close(opening);
      const unsigned int n = arguments.size();
      if (n < function.least_arguments || n > function.most_arguments)
        complaints.about_number_of_arguments(function, n);

      if (function.has_condition && !arguments[0].is_truth)
        complaints.about_condition(arguments[0], "as the first argument of '" + function.name + "'");
      if (function.has_condition && arguments[1].is_truth != arguments[2].is_truth)
        complaints.about_choice(arguments[1], arguments[2]);
      for (const Part &argument : arguments)
        if (!function.has_condition && argument.is_truth)
          complaints.about_argument(function.name, argument);
      return Part(function.has_condition && arguments[1].is_truth, token.position, tokens[next - 1].behind(),
                  function.has_condition ? node(Kind::conditional, "", arguments)
                                         : node(Kind::function, function.name, arguments));
    }

    static ExpressionTree node(const Kind kind, const std::string &name, const std::vector<Part> &arguments)
    {
      std::vector<ExpressionTree> trees;
      for (const Part &argument : arguments)
        trees.push_back(argument.tree);
      return std::make_shared<ExpressionNode>(kind, name, trees);
    }

    /** A variable, or the number that a constant stands for. */
    static ExpressionTree quantity(const std::string &name)
    {
      for (const ExpressionConstant &constant : expression_constants())
        if (constant.name == name)
          return std::make_shared<ExpressionNode>(constant.value);
      return node(Kind::variable, name, {});
    }

    const Token &here() const { return tokens[next]; }

    const ExpressionScope &scope;
    const std::vector<Token> tokens;
    const ExpressionComplaints complaints;
    const SyntaxComplaints syntax;
    /** The tokens as muParser gets them. */
    std::vector<std::string> written;
    unsigned int next = 0, depth = 0;
  };
} // namespace

CheckedExpression checked_expression(const std::string &expression, const ExpressionScope &scope)
{
  if (expression.size() > longest)
    throw ExpressionError("has " + std::to_string(expression.size()) + " characters, more than the " +
                              std::to_string(longest) + " that are possible.",
                          "Write it shorter.");
  return Checker(expression, scope).run();
}
} // namespace Gemmule::Parameters
