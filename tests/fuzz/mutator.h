// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <cctype>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace Gemmule::Testing
{
/**
 * Makes wrong parameter files and command lines out of right ones. The same seed gives the same sequence on
 * every machine: only the generator itself is used, no distribution of the standard library.
 */
class Mutator
{
public:
  /** @param corpus right files  @param words names of parameters and sections, operators, functions */
  Mutator(std::vector<std::string> corpus, std::vector<std::string> words)
      : corpus(std::move(corpus)), words(std::move(words))
  {
  }

  void seed(const unsigned long long seed_) { random.seed(seed_); }

  /** A file of the corpus after one to four changes. */
  std::string file()
  {
    std::string text = any(corpus);
    for (unsigned int i = 1 + below(4); i > 0; --i)
      change(text);
    return text;
  }

  /** Zero to three assignments as for --set. */
  std::vector<std::string> assignments(const std::vector<std::string> &parameters)
  {
    std::vector<std::string> result;
    for (unsigned int i = below(4); i > 0; --i)
    {
      std::string text = any(parameters) + "=" + (below(3) == 0 ? expression(4) : number());
      if (below(4) == 0)
        change_bytes(text);
      result.push_back(text);
    }
    return result;
  }

  /** Arguments of the program. */
  std::vector<std::string> arguments(const std::vector<std::string> &parameters)
  {
    static const std::vector<std::string> options = {
        "--set",     "--output",    "--resume", "--check",    "--print-parameters",
        "--version", "--help",      "-h",       "--",         "--set=",
        "--=",       "-",           "---",      "--output=a", "",
        "a.prm",     "--check=yes", "--SET",    "@file",      "--no-check"};
    std::vector<std::string> result{"gemmule"};
    for (unsigned int i = below(6); i > 0; --i)
    {
      std::string text = below(2) == 0 ? any(options) : any(parameters) + "=" + number();
      if (below(4) == 0)
        change_bytes(text);
      // an argument ends at its first zero byte
      result.push_back(text.substr(0, text.find('\0')));
    }
    return result;
  }

  /** An expression in x, y and t, most of them well formed. */
  std::string expression(const unsigned int depth)
  {
    static const std::vector<std::string> functions = {"sin", "cos", "sqrt", "log",  "exp", "tan",
                                                       "abs", "int", "acos", "sinh", "erf", "rand"};
    static const std::vector<std::string> operators = {"+", "-", "*", "/", "^", "<", "==", "&&"};
    if (depth == 0 || below(5) == 0)
    {
      const unsigned int kind = below(8);
      return kind < 2   ? "x"
             : kind < 4 ? "y"
             : kind < 5 ? "t"
             : kind < 6 ? number()
                        : std::to_string(below(9));
    }
    switch (below(7))
    {
    case 0:
      return any(functions) + "(" + expression(depth - 1) + ")";
    case 1:
      return "if(" + expression(depth - 1) + "," + expression(depth - 1) + "," + expression(depth - 1) + ")";
    case 2:
      return "-(" + expression(depth - 1) + ")";
    case 3: // a shape that is likely to lie in the box, plus something
      return "x^2+" + std::to_string(1 + below(8)) + "*y^2-0.2+0.01*(" + expression(depth - 1) + ")";
    default:
      return "(" + expression(depth - 1) + ")" + any(operators) + "(" + expression(depth - 1) + ")";
    }
  }

private:
  unsigned int below(const unsigned int n) { return random() % n; }

  template <typename T>
  const T &any(const std::vector<T> &list)
  {
    return list[below(list.size())];
  }

  std::string number()
  {
    static const std::vector<std::string> special = {
        "0",    "-0",         "-1",         "1",          "0.5",        "2",           "3",
        "5",    "1e-3",       "1e-8",       "1e-17",      "1e-300",     "5e-324",      "1e17",
        "1e30", "1e300",      "1e308",      "-1e308",     "nan",        "-nan",        "inf",
        "-inf", "1e999",      "20",         "21",         "30",         "31",          "32",
        "64",   "2147483647", "2147483648", "4294967295", "4294967296", "-2147483649", "0x10",
        "1e",   "1e+",        ".",          "1.2.3",      "--1",        "+1",          "+-1",
        "1 2",  "1,2",        "1, 2, 3",    ",",          "-1, -1",     "true",        "none",
        "",     "1000000"};
    return any(special);
  }

  void change_bytes(std::string &text)
  {
    const unsigned int position = below(text.size() + 1);
    switch (below(4))
    {
    case 0: // any byte
      text.insert(position, 1, static_cast<char>(below(256)));
      break;
    case 1: // another bit
      if (position < text.size())
        text[position] = static_cast<char>(text[position] ^ (1 << below(8)));
      break;
    case 2: // a piece less
      text.erase(position, 1 + below(20));
      break;
    default: // one character many times: long names, deep parentheses
      text.insert(position, 1 + below(3000), "(-9 =#/x;\\"[below(10)]);
    }
  }

  std::vector<std::string> lines_of(const std::string &text) const
  {
    std::vector<std::string> lines(1);
    for (const char c : text)
      if (c == '\n')
        lines.emplace_back();
      else
        lines.back() += c;
    return lines;
  }

  std::string joined(const std::vector<std::string> &lines) const
  {
    std::string text;
    for (const std::string &line : lines)
      text += line + "\n";
    return text;
  }

  void change_lines(std::string &text)
  {
    auto lines = lines_of(text);
    const unsigned int i = below(lines.size()), j = below(lines.size());
    switch (below(5))
    {
    case 0:
      lines.erase(lines.begin() + i);
      break;
    case 1:
      lines.insert(lines.begin() + i, std::string(lines[j]));
      break;
    case 2:
      std::swap(lines[i], lines[j]);
      break;
    case 3:
      lines[i] += "\\";
      break;
    default:
    {
      const auto other = lines_of(any(corpus));
      lines.insert(lines.begin() + i, other[below(other.size())]);
    }
    }
    text = joined(lines);
  }

  /** Another value for one of the parameters. */
  void change_value(std::string &text)
  {
    auto lines = lines_of(text);
    std::vector<unsigned int> settings;
    for (unsigned int i = 0; i < lines.size(); ++i)
      if (lines[i].find('=') != std::string::npos && lines[i].find("set ") != std::string::npos)
        settings.push_back(i);
    if (settings.empty())
      return;
    std::string &line = lines[any(settings)];
    const unsigned int kind = below(4);
    line = line.substr(0, line.find('=') + 1) + " " +
           (kind == 0   ? expression(4)
            : kind == 1 ? expression(3) + "; " + expression(3)
            : kind == 2 ? any(words)
                        : number());
    text = joined(lines);
  }

  /** Another number where one stands. */
  void change_number(std::string &text)
  {
    std::vector<std::size_t> starts;
    for (std::size_t i = 0; i < text.size(); ++i)
      if (std::isdigit(static_cast<unsigned char>(text[i])) &&
          (i == 0 || !std::isalnum(static_cast<unsigned char>(text[i - 1]))))
        starts.push_back(i);
    if (starts.empty())
      return;
    const std::size_t start = any(starts);
    const std::size_t end = std::min(text.find_first_not_of("0123456789.", start), text.size());
    text.replace(start, end - start, number());
  }

  void change(std::string &text)
  {
    switch (below(8))
    {
    case 0:
      change_bytes(text);
      break;
    case 1:
      change_lines(text);
      break;
    case 2:
    case 3:
      change_value(text);
      break;
    case 4:
    case 5:
      change_number(text);
      break;
    case 6:
      text.insert(below(text.size() + 1), any(words));
      break;
    default:
      text.resize(below(text.size() + 1));
    }
  }

  std::mt19937_64 random;
  const std::vector<std::string> corpus, words;
};
} // namespace Gemmule::Testing
