// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/line_advice.h>
#include <gemmule/parameters/suggestion.h>
#include <gemmule/parameters/text.h>

#include <algorithm>
#include <cctype>
#include <set>

namespace Gemmule::Parameters
{
namespace
{
  std::string small(const std::string &text)
  {
    std::string result = text;
    std::transform(result.begin(), result.end(), result.begin(),
                   [](const unsigned char c) { return std::tolower(c); });
    return result;
  }

  /** Without blanks and without what other formats put around names. */
  std::string bare(const std::string &text)
  {
    const char *const marks = " \t[]{}<>/\"':,;&$=";
    const auto begin = text.find_first_not_of(marks);
    return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(marks) + 1 - begin);
  }

  std::vector<std::string> all_keys(const Schema &schema)
  {
    std::set<std::string> names;
    for (const auto &[path, entry] : schema.entries())
      names.insert(Schema::split(path).second);
    return {names.begin(), names.end()};
  }

  std::vector<std::string> all_sections(const Schema &schema)
  {
    std::set<std::string> names;
    for (const auto &[path, entry] : schema.entries())
      for (std::string rest = Schema::split(path).first; !rest.empty(); rest = Schema::split(rest).first)
        names.insert(Schema::split(rest).second);
    return {names.begin(), names.end()};
  }

  /** The name among the candidates with another use of capital letters, or an empty string. */
  std::string same_name(const std::string &name, const std::vector<std::string> &candidates)
  {
    for (const std::string &candidate : candidates)
      if (small(candidate) == small(name))
        return candidate;
    return "";
  }

  /** The parameter of the section that is meant, otherwise one of another section. */
  std::string similar_key(const std::string &name, const std::string &section, const Schema &schema)
  {
    const std::string here = nearest(name, schema.keys(section));
    return here.empty() ? nearest(name, all_keys(schema)) : here;
  }

  std::string quote(const std::string &text)
  {
    return "'" + printable(shortened(text)) + "'";
  }
} // namespace

std::string advice_for_line(const std::string &line, const std::string &section, const Schema &schema)
{
  const std::string general =
      "Lines are 'subsection NAME', 'set Name = value', 'end', or comments after '#'.";
  for (const char *const comment : {"//", "/*", "--", "%", "!", ";"})
    if (line.rfind(comment, 0) == 0)
      return "Comments begin with '#'. " + general;

  const std::string word = line.substr(0, line.find_first_of(" \t")), small_word = small(word);
  const std::string rest = bare(line.substr(word.size()));
  // "End time = 1" begins with no keyword.
  for (const char *const keyword : {"set", "subsection", "end"})
    if (small_word == keyword && (small_word != "end" || rest.empty()))
      return "Write " + quote(keyword) + " in small letters.";

  const std::string::size_type equals = line.find('=');
  const std::string name = bare(line.substr(0, std::min(equals, line.find(':'))));
  const std::vector<std::string> keys = all_keys(schema), sections = all_sections(schema);
  if (equals != std::string::npos || line.find(':') < line.size() - 1)
  {
    const std::string mark = equals != std::string::npos ? "" : " and '=' in the place of ':'";
    if (!same_name(name, keys).empty() && mark.empty())
      return "Is 'set' missing in front of it?";
    if (small_word.rfind("set", 0) == 0 && !same_name(bare(name.substr(3)), keys).empty())
      return "Write a blank behind 'set'.";
    const std::string::size_type blank = name.find_first_of(" \t");
    if (blank != std::string::npos && edit_distance(word, "set") < 2)
      return "Did you mean 'set' instead of " + quote(word) + "?";
    const std::string key = similar_key(name, section, schema);
    if (!key.empty())
      return mark.empty() ? "Is 'set' missing in front of it?" : "Write 'set " + key + " = value'.";
    return "If it sets a parameter, 'set' is missing in front of it: write 'set Name = value'.";
  }

  if (line[0] == '}' || (small_word.rfind("end", 0) == 0 && edit_distance(word, "end") > 1 && rest.empty() &&
                         same_name(word, keys).empty() && nearest(word, keys).empty()))
    return "A section ends with 'end' on a line of its own.";
  if (edit_distance(word, "subsection") < 4)
    return "Did you mean 'subsection' instead of " + quote(word) + "?";
  if (small_word.rfind("subsection", 0) == 0)
    return "Write a blank behind 'subsection'.";
  if (small_word == "sub" || small_word == "begin" || small_word == "block" || small_word == "group")
    return "A section begins with 'subsection NAME'.";
  if (rest.empty() && edit_distance(word, "end") < 2)
    return "Did you mean 'end'?";
  if (const std::string found = nearest(bare(line), sections); !found.empty())
    return "Is 'subsection' missing in front of it? A section begins with 'subsection " + found +
           "' and ends with 'end'.";
  if (edit_distance(word, "set") < 2 && !rest.empty())
    return "Did you mean 'set' instead of " + quote(word) + "? Write 'set Name = value'.";
  if (const std::string found = similar_key(bare(line), section, schema); !found.empty())
    return "If it sets a parameter, write 'set " + found + " = value'.";
  // "End time 3"
  for (const std::string &key : keys)
    if (small(line).rfind(small(key) + " ", 0) == 0)
      return "If it sets a parameter, write 'set " + key + " = value'.";
  return general;
}
} // namespace Gemmule::Parameters
