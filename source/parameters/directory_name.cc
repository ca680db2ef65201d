// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/directory_name.h>
#include <gemmule/parameters/text.h>

#include <cctype>
#include <initializer_list>
#include <sstream>
#include <vector>

namespace Gemmule::Parameters
{
namespace
{
  const std::string no_shell = ", which is not replaced here as a shell does it. Write out what is meant.";

  bool starts_with(const std::string &text, const std::string &start)
  {
    return text.compare(0, start.size(), start) == 0;
  }

  bool ends_with(const std::string &text, const std::string &end)
  {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
  }

  bool begins_a_name(const char c)
  {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
  }

  /** '$NAME', '${NAME}', '$(command)' and '$1', or '%NAME%' as on Windows; empty if there is none. */
  std::string variable_in(const std::string &name)
  {
    for (std::size_t i = 0; i + 1 < name.size(); ++i)
      if (name[i] == '$' && (std::isalnum(static_cast<unsigned char>(name[i + 1])) != 0 ||
                             std::string("_{([").find(name[i + 1]) != std::string::npos))
      {
        std::size_t end = i + 1;
        while (end < name.size() && name[end] != '/')
          ++end;
        return name.substr(i, end - i);
      }
    for (std::size_t i = name.find('%'); i != std::string::npos; i = name.find('%', i + 1))
    {
      std::size_t end = i + 1;
      while (end < name.size() &&
             (begins_a_name(name[end]) || std::isdigit(static_cast<unsigned char>(name[end]))))
        ++end;
      if (end > i + 1 && begins_a_name(name[i + 1]) && end < name.size() && name[end] == '%')
        return name.substr(i, end + 1 - i);
    }
    return "";
  }

  std::vector<std::string> components_of(const std::string &name)
  {
    std::vector<std::string> components;
    std::istringstream stream(name);
    for (std::string component; std::getline(stream, component, '/');)
      components.push_back(component);
    return components;
  }

  /** The first of @p marks with which @p text begins or ends. */
  std::string mark_around(const std::string &text, const std::initializer_list<const char *> marks)
  {
    for (const std::string mark : marks)
      if (starts_with(text, mark) || ends_with(text, mark))
        return mark;
    return "";
  }
} // namespace

std::string flaw_of_directory_name(const std::string &name)
{
  if (name.find_first_not_of(' ') == std::string::npos)
    return "is empty. Give the name of a directory; '.' is the one in which the program is started.";
  for (const char c : name)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      return "is " + in_quotes(name) + ", which holds a control character. Choose another name.";

  const std::string is = "is " + in_quotes(name);
  if (name[0] == '~')
    return is + ": it begins with '~'" + no_shell;
  if (const std::string variable = variable_in(name); !variable.empty())
    return is + ": it holds " + in_quotes(variable) + no_shell;
  for (const char c : {'`', '*', '?'})
    if (name.find(c) != std::string::npos)
      return is + ": it holds '" + c + "'" + no_shell;
  if (name.find('"') != std::string::npos)
    return is + ": it holds a quotation mark, which would belong to the name. Leave it out.";
  if (name.find('\\') != std::string::npos)
    return is + ": it holds a backslash, which would belong to the name. Separate directories by '/'.";
  if (name[0] == '-')
    return is + ": it begins with '-', so that commands would take it for an option. Write './" + name +
           "' if it is meant.";

  std::vector<std::string> parts = components_of(name);
  parts.push_back(name);
  for (const std::string &part : parts)
  {
    // Apostrophes within a name are common.
    if (!mark_around(part, {"'", "\u2018", "\u2019", "\u201c", "\u201d", "\u201e", "\u00ab", "\u00bb"})
             .empty())
      return is + ": it holds a quotation mark, which would belong to the name. Leave it out.";
    if (!mark_around(part, {" ", "\u00a0", "\u2007", "\u200b", "\u202f", "\u3000", "\ufeff"}).empty())
      return is + ": a name in it begins or ends with a blank. Leave the blank out.";
  }
  return "";
}
} // namespace Gemmule::Parameters
