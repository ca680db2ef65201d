// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/parameters/section.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <charconv>
#include <cmath>
#include <sstream>

namespace Gemmule::Parameters
{
namespace
{
  /** Pattern that describes the allowed values in words of ours and leaves the test to a function. */
  class AllowedValues : public dealii::Patterns::PatternBase
  {
  public:
    AllowedValues(const std::string &allowed, const std::function<bool(const std::string &)> &test)
        : allowed(allowed), test(test)
    {
    }
    bool match(const std::string &text) const override { return test(text); }
    std::string description(const OutputStyle) const override { return allowed; }
    std::unique_ptr<PatternBase> clone() const override { return std::make_unique<AllowedValues>(*this); }

  private:
    const std::string allowed;
    const std::function<bool(const std::string &)> test;
  };

  bool read_number(const std::string &text, double &value)
  {
    // from_chars takes neither spaces nor a leading plus, and is independent of the locale.
    std::string trimmed = dealii::Utilities::trim(text);
    if (trimmed.size() > 1 && trimmed[0] == '+' && trimmed[1] != '-')
      trimmed.erase(0, 1);
    const char *end = trimmed.data() + trimmed.size();
    const auto [last, error] = std::from_chars(trimmed.data(), end, value);
    return error == std::errc() && last == end && std::isfinite(value);
  }

  bool read_unsigned(const std::string &text, unsigned int &value)
  {
    const std::string trimmed = dealii::Utilities::trim(text);
    const char *end = trimmed.data() + trimmed.size();
    const auto [last, error] = std::from_chars(trimmed.data(), end, value);
    return error == std::errc() && last == end;
  }

  bool read_list(const std::string &text, std::vector<double> &values)
  {
    values.clear();
    if (dealii::Utilities::trim(text).empty())
      return true;
    std::istringstream stream(text);
    std::string item;
    while (std::getline(stream, item, ','))
    {
      values.push_back(0.);
      if (!read_number(item, values.back()))
        return false;
    }
    // A comma at the end announces a number that is not there.
    return text.find_last_not_of(" \t") != text.rfind(',') || text.find(',') == std::string::npos;
  }

  bool read_bool(const std::string &text, bool &value)
  {
    const std::string trimmed = dealii::Utilities::trim(text);
    value = trimmed == "true" || trimmed == "yes" || trimmed == "on";
    return value || trimmed == "false" || trimmed == "no" || trimmed == "off";
  }
} // namespace

bool Range::contains(const double value) const
{
  return std::isfinite(value) && (open ? value > lower : value >= lower) && value <= upper;
}

std::string Range::describe(const std::string &noun) const
{
  if (std::isfinite(lower) && std::isfinite(upper))
    return noun + (open ? " greater than " : " from ") + to_text(lower) + (open ? " and up to " : " to ") +
           to_text(upper);
  if (std::isfinite(lower))
    return noun + (open ? " > " : " >= ") + to_text(lower);
  if (std::isfinite(upper))
    return noun + " <= " + to_text(upper);
  return noun;
}

std::string to_text(const double value)
{
  char buffer[64];
  const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
  return std::string(buffer, result.ptr);
}

Section::Section(dealii::ParameterHandler &prm, std::vector<std::string> names)
    : prm(prm), names(std::move(names))
{
  for (const std::string &name : this->names)
    prm.enter_subsection(name);
}

Section::~Section()
{
  for (unsigned int i = 0; i < names.size(); ++i)
    prm.leave_subsection();
}

void Section::declare(const std::string &key, const std::string &value, const std::string &description,
                      const std::string &allowed, const Match &match, const Assign &assign)
{
  if (!match(value))
  {
    std::string path;
    for (const std::string &name : names)
      path += name + "/";
    throw ParameterError(path + key, "the value '" + value + "' is not allowed; expected " + allowed + ".");
  }
  prm.declare_entry(key, value, AllowedValues(allowed, match), description + " Expected: " + allowed + ".");
  prm.add_action(key, assign);
}

void Section::add(const std::string &key, double &value, const std::string &description, const Range &range)
{
  declare(
      key, to_text(value), description, range.describe("a number"),
      [range](const std::string &text)
      {
        double number;
        return read_number(text, number) && range.contains(number);
      },
      [&value](const std::string &text) { read_number(text, value); });
}

void Section::add(const std::string &key, unsigned int &value, const std::string &description,
                  const Range &range)
{
  // Without a bound there is still that of the machine.
  declare(
      key, std::to_string(value), description,
      range.describe("an integer") + (std::isfinite(range.upper) ? "" : " and < 2^32"),
      [range](const std::string &text)
      {
        unsigned int number;
        return read_unsigned(text, number) && range.contains(number);
      },
      [&value](const std::string &text) { read_unsigned(text, value); });
}

void Section::add(const std::string &key, bool &value, const std::string &description)
{
  declare(
      key, value ? "true" : "false", description, "true or false",
      [](const std::string &text)
      {
        bool truth;
        return read_bool(text, truth);
      },
      [&value](const std::string &text) { read_bool(text, value); });
}

void Section::add(const std::string &key, std::string &value, const std::string &description,
                  const std::string &kind)
{
  declare(
      key, value, description, kind,
      [](const std::string &text) { return !dealii::Utilities::trim(text).empty(); },
      [&value](const std::string &text) { value = text; });
}

void Section::add(const std::string &key, std::vector<double> &value, const std::string &description,
                  const Range &range, const unsigned int least)
{
  std::string present;
  for (const double number : value)
    present += (present.empty() ? "" : ", ") + to_text(number);
  std::string allowed = "numbers separated by commas, each of them " + range.describe("a number");
  if (least > 0)
    allowed = "at least " + std::to_string(least) + " " + allowed;
  declare(
      key, present, description, allowed,
      [range, least](const std::string &text)
      {
        std::vector<double> numbers;
        return read_list(text, numbers) && numbers.size() >= least &&
               std::all_of(numbers.begin(), numbers.end(), [&](const double x) { return range.contains(x); });
      },
      [&value](const std::string &text) { read_list(text, value); });
}

void Section::add_choice(const std::string &key, const std::string &value, const std::string &description,
                         const std::vector<std::string> &choices, const Assign &assign)
{
  std::string allowed = "one of: ";
  for (const std::string &choice : choices)
    allowed += (choice == choices.front() ? "'" : ", '") + choice + "'";
  declare(
      key, value, description, allowed,
      [choices](const std::string &text)
      { return std::find(choices.begin(), choices.end(), text) != choices.end(); },
      assign);
}
} // namespace Gemmule::Parameters
