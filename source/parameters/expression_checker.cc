// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/expression_checker.h>
#include <gemmule/parameters/expression_complaints.h>
#include <gemmule/parameters/text.h>

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
        : expression(expression), scope(scope), tokens(expression_tokens(expression)), complaints(expression)
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
        refuse_rest();
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
        throw ExpressionError("has a '?' without its ':', " + place(here()) + ".",
                              "Write 'if(condition, value, other value)'.");
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
        throw ExpressionError("has two signs in a row, " + place(here()) + ".",
                              "Leave them out, or put the second into parentheses, as in -(-x).");
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
        throw ExpressionError("has '^1/', which takes the power first and divides then.",
                              "Write '" + complaints.text(base) + "^(1/" +
                                  (tokens[next + 2].kind == Token::number ? tokens[next + 2].text : "...") +
                                  ")'.");
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
      const Part result = token.kind == Token::number                ? number()
                          : token.kind == Token::name                ? named()
                          : token.kind == Token::opening_parenthesis ? enclosed()
                          : token.is("!")                            ? negation()
                                                                     : refuse_missing_operand();
      if (here().is("!"))
        throw ExpressionError(
            "has a '!' behind " + complaints.quoted(result) + ".",
            "'!' means 'not' and stands in front of a condition, as in !(x>0); there are no "
            "factorials.");
      if (here().kind == Token::number || here().kind == Token::name ||
          here().kind == Token::opening_parenthesis)
        refuse_neighbour(result);
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
      const Token &opening = tokens[next++];
      if (here().kind == Token::closing_parenthesis)
        throw ExpressionError("has empty parentheses, " + place(opening) + ".", "");
      Part result = conditional();
      if (here().kind == Token::comma)
        throw ExpressionError("has a comma in parentheses that belong to no function, " + place(here()) + ".",
                              "Decimals are written with a point.");
      close(opening);
      result.begin = opening.position;
      result.end = tokens[next - 1].behind();
      return result;
    }

    void close(const Token &opening)
    {
      if (here().kind != Token::closing_parenthesis)
        throw ExpressionError("lacks a ')' for the '(' " + place(opening) + ".", "");
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
      const Token &token = tokens[next++];
      const bool is_called = here().kind == Token::opening_parenthesis;
      if (scope.has_quantity(token.text))
        return Part(false, token.position, token.behind(), quantity(token.text));
      const ExpressionFunction *const function = find_expression_function(token.text);
      if (function == nullptr)
        refuse_unknown(token, is_called);
      if (is_called)
        return call(*function, token);

      std::string remedy = "Write '" + function->usage + "'.";
      if (here().is("^"))
        remedy = "Write a power behind the argument, as in " + token.text + "(x)^2.";
      else if (function->least_arguments == 1 && here().kind == Token::name &&
               scope.has_quantity(here().text))
        remedy = "Write '" + token.text + "(" + here().text + ")'.";
      throw ExpressionError("names the function '" + token.text + "' without its argument in parentheses.",
                            remedy);
    }

    Part call(const ExpressionFunction &function, const Token &token)
    {
      const Token &opening = tokens[next++];
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

    [[noreturn]] Part refuse_missing_operand() const
    {
      const Token &token = here();
      throw ExpressionError("lacks a number, a name or a parenthesis " +
                                (next > 0 ? "behind '" + tokens[next - 1].text + "', " : "") + place(token) +
                                ".",
                            "");
    }

    [[noreturn]] void refuse_rest() const
    {
      if (here().kind == Token::comma)
        throw ExpressionError("has a comma outside of parentheses; decimals are written with a point, and "
                              "components are separated by semicolons.",
                              "");
      if (here().kind == Token::closing_parenthesis)
        throw ExpressionError("has a ')' without its '(', " + place(here()) + ".", "");
      throw ExpressionError("has a ':' without its '?', " + place(here()) + ".",
                            "Write 'if(condition, value, other value)'.");
    }

    [[noreturn]] void refuse_unknown(const Token &token, const bool is_called) const
    {
      if (token.text.compare(0, 4, "rand") == 0) // each process would draw numbers of its own
        throw ExpressionError(
            "uses random numbers, which differ from process to process and from run to run.",
            "Use sines and cosines.");
      throw ExpressionError((is_called ? "calls " : "has the name ") + in_quotes(token.text) +
                                (is_called ? ", which is no function here." : ", which is not known here."),
                            remedy_for_unknown_name(token.text, is_called, scope));
    }

    /** Two parts without an operator between them. */
    [[noreturn]] void refuse_neighbour(const Part &part) const
    {
      const Token &token = here();
      if (token.kind == Token::name && !scope.has_quantity(token.text) &&
          find_expression_function(token.text) == nullptr)
        refuse_unknown(token, tokens[next + 1].kind == Token::opening_parenthesis);
      const std::string complaint =
          "has no operator between " + complaints.quoted(part) + " and " + in_quotes(token.text) + ".";
      if (part.is_truth)
        throw ExpressionError(complaint, "Write '&&' or '||' there.");
      refuse_forgotten_product(part, complaint);
    }

    [[noreturn]] void refuse_forgotten_product(const Part &part, const std::string &complaint) const
    {
      const Token &token = here();
      if (token.kind == Token::number && tokens[next - 1].kind == Token::number)
        throw ExpressionError(complaint, "Numbers are written without blanks in them.");
      const bool is_called = token.kind == Token::opening_parenthesis || find_expression_function(token.text);
      const std::string product =
          complaints.text(part) + "*" + (token.kind == Token::name ? printable(shortened(token.text)) : "") +
          (token.kind == Token::number ? token.text : "") + (is_called ? "(...)" : "");
      bool is_below_a_line = false;
      for (unsigned int i = 1; i < tokens.size(); ++i)
        is_below_a_line = is_below_a_line || (tokens[i].position == part.begin && tokens[i - 1].is("/"));
      throw ExpressionError(complaint, is_below_a_line
                                           ? "Write '(" + product +
                                                 ")' if all of it stands below the fraction line, '" +
                                                 product + "' if only its first part does."
                                           : "Write '" + product + "' for a product.");
    }

    const Token &here() const { return tokens[next]; }
    std::string place(const Token &token) const
    {
      return token.kind == Token::end ? "at its end"
                                      : "at its character " + std::to_string(token.position + 1);
    }

    const std::string &expression;
    const ExpressionScope &scope;
    const std::vector<Token> tokens;
    const ExpressionComplaints complaints;
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
