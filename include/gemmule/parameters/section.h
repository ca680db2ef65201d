// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace dealii
{
class ParameterHandler;
}

namespace Gemmule::Parameters
{
/** Interval that a number has to lie in. */
struct Range
{
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  /** Whether #lower itself is excluded. */
  bool open = false;

  static Range any() { return {}; }
  static Range positive() { return {0., std::numeric_limits<double>::infinity(), true}; }
  static Range non_negative() { return {0., std::numeric_limits<double>::infinity(), false}; }
  static Range at_least(const double lower)
  {
    return {lower, std::numeric_limits<double>::infinity(), false};
  }
  static Range between(const double lower, const double upper) { return {lower, upper, false}; }

  bool contains(double value) const;
  /** For messages, for example "a number > 0"; @p noun is "a number" or "an integer". */
  std::string describe(const std::string &noun) const;
};

/** Shortest decimal text that reads back as exactly the same number. */
std::string to_text(double value);

/**
 * Binds the members of a struct to the keys of one section of a parameter file. The object enters the
 * section when it is created and leaves it when it goes out of scope.
 *
 * Each add() declares one key, with the member's present value as default and with a pattern that states
 * the allowed values in words, and writes the value that a file gives back into the member. A present value
 * that is not allowed throws a ParameterError: to declare is also to check.
 */
class Section
{
public:
  /** @param names section and subsections, from the outside to the inside; empty for the top level */
  Section(dealii::ParameterHandler &prm, std::vector<std::string> names);
  ~Section();
  Section(const Section &) = delete;
  Section &operator=(const Section &) = delete;

  void add(const std::string &key, double &value, const std::string &description, const Range &range);
  void add(const std::string &key, unsigned int &value, const std::string &description,
           const Range &range = Range::non_negative());
  void add(const std::string &key, bool &value, const std::string &description);
  /** Text; @p kind says in messages what kind of text, for example "an expression". It must not be empty. */
  void add(const std::string &key, std::string &value, const std::string &description,
           const std::string &kind);
  /** Numbers separated by commas; @p least is the smallest number of them. */
  void add(const std::string &key, std::vector<double> &value, const std::string &description,
           const Range &range, unsigned int least = 0);
  /** One of several names, each standing for a value of an enumeration. */
  template <typename Enumeration>
  void add(const std::string &key, Enumeration &value, const std::string &description,
           const std::vector<std::pair<std::string, Enumeration>> &choices)
  {
    std::vector<std::string> names;
    std::string present;
    for (const auto &[name, choice] : choices)
    {
      names.push_back(name);
      if (choice == value)
        present = name;
    }
    add_choice(key, present, description, names,
               [&value, choices](const std::string &text)
               {
                 for (const auto &[name, choice] : choices)
                   if (name == text)
                     value = choice;
               });
  }

private:
  using Match = std::function<bool(const std::string &)>;
  using Assign = std::function<void(const std::string &)>;

  void declare(const std::string &key, const std::string &value, const std::string &description,
               const std::string &allowed, const Match &match, const Assign &assign);
  void add_choice(const std::string &key, const std::string &value, const std::string &description,
                  const std::vector<std::string> &names, const Assign &assign);

  dealii::ParameterHandler &prm;
  const std::vector<std::string> names;
};
} // namespace Gemmule::Parameters
