// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/parameters/line_advice.h>
#include <gemmule/parameters/strict_parser.h>
#include <gemmule/parameters/suggestion.h>
#include <gemmule/parameters/text.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace Gemmule::Parameters
{
namespace
{
  const std::string command_line = "command line";

  /** Removes blanks at both ends and makes each run of blanks in between one space. */
  std::string normalise(const std::string &text)
  {
    std::istringstream stream(text);
    std::string result;
    for (std::string word; stream >> word;)
      result += (result.empty() ? "" : " ") + word;
    return result;
  }

  std::string list(const std::vector<std::string> &names)
  {
    std::string result;
    for (const std::string &name : names)
      result += (result.empty() ? "'" : ", '") + name + "'";
    return result;
  }

  /** The names in the text "one of: 'a', 'b'" that describes a choice; none for other texts. */
  std::vector<std::string> choices(const std::string &allowed)
  {
    std::vector<std::string> names;
    if (allowed.rfind("one of: ", 0) != 0)
      return names;
    for (std::string::size_type begin = allowed.find('\''); begin != std::string::npos;)
    {
      const std::string::size_type end = allowed.find('\'', begin + 1);
      names.push_back(allowed.substr(begin + 1, end - begin - 1));
      begin = end == std::string::npos ? end : allowed.find('\'', end + 1);
    }
    return names;
  }

  std::string in_section(const std::string &section)
  {
    return section.empty() ? "at the top level" : "in section '" + section + "'";
  }

  /** If the line starts with the keyword (all small or all capital letters), the rest of the line. */
  bool starts_with(const std::string &line, const std::string &keyword, std::string &rest)
  {
    const std::string word = line.substr(0, line.find_first_of(" \t"));
    std::string capitals = keyword;
    std::transform(capitals.begin(), capitals.end(), capitals.begin(),
                   [](unsigned char c) { return std::toupper(c); });
    if (word != keyword && word != capitals)
      return false;
    rest = normalise(line.substr(word.size()));
    return true;
  }
} // namespace

StrictParser::StrictParser(dealii::ParameterHandler &prm) : prm(prm), schema(prm) {}

void StrictParser::parse_text(const std::string &file, const std::string &text)
{
  std::istringstream stream(text);
  SourceLine logical_line;
  unsigned int line_number = 0;
  bool is_continued = false;
  for (std::string line; std::getline(stream, line);)
  {
    ++line_number;
    if (line_number == 1 && line.compare(0, 3, "\xEF\xBB\xBF") == 0)
      line.erase(0, 3);
    if (!line.empty() && line.back() == '\r')
      line.pop_back();
    const std::string here = file + ":" + std::to_string(line_number);
    if (line.find('\0') != std::string::npos)
      throw UserError(here + ": the line holds a zero byte, so that this is no plain text. Save the file as "
                             "text in UTF-8.");
    // What stands behind it looks like a line of its own, and would belong to a comment in front of it.
    if (line.find('\r') != std::string::npos)
      throw UserError(here + ": the line holds a carriage return (\\x0D) that does not end it. Save the file "
                             "with the line ends of Unix or Windows.");
    const std::string code = line.substr(0, line.find('#'));
    if (const std::string flaw = flaw_of_text(code); !flaw.empty())
      throw UserError(here + ": the line " + flaw + ". Remove it: parameter files are plain text in UTF-8.");
    refuse_invisible_characters(code, here);

    std::string::size_type begin = std::min(code.find_first_not_of(" \t"), code.size());
    std::string::size_type end = code.find_last_not_of(" \t") + 1;
    is_continued = end > begin && code[end - 1] == '\\';
    if (is_continued)
      --end;
    logical_line.append(line, begin, std::max(begin, end), here);
    if (is_continued)
      continue;
    parse_line(logical_line);
    logical_line = SourceLine();
  }
  if (is_continued)
    throw UserError(file + ":" + std::to_string(line_number) +
                    ": the file ends with a backslash, which announces another line. Remove it.");
  if (!open_sections.empty())
    throw UserError(open_sections.back().place + ": the section '" + open_sections.back().path +
                    "' that starts here has no 'end'. Add a line 'end' after its last parameter.");
}

void StrictParser::parse_line(const SourceLine &source)
{
  const std::string &line = source.text(), &place = source.place();
  const std::string section = open_sections.empty() ? "" : open_sections.back().path;
  std::string rest;
  if (line.empty())
    return;
  if (starts_with(line, "subsection", rest))
    enter(rest, source);
  else if (starts_with(line, "end", rest))
  {
    if (!rest.empty())
      throw UserError(place + ": nothing may follow 'end', but there is " + in_quotes(rest) +
                      ". Write it into a line of its own, or as a comment after '#'.");
    if (open_sections.empty())
      throw UserError(place +
                      ": this 'end' closes no section. Remove it, or look for a missing 'subsection' above.");
    open_sections.pop_back();
  }
  else if (starts_with(line, "set", rest))
  {
    const std::string::size_type equals = line.find('=');
    if (equals == std::string::npos)
    {
      source.refuse_foreign_characters();
      throw UserError(place + ": " + in_quotes(line) + " has no '='. Write 'set Name = value'.");
    }
    const std::string key = normalise(line.substr(3, equals - 3));
    if (key.empty())
      throw UserError(place + ": " + in_quotes(line) + " names no parameter. Write 'set Name = value'.");
    if (key.find('/') != std::string::npos)
      throw UserError(place + ": the name " + in_quotes(key) +
                      " has a '/', as on the command line. In a file write 'subsection NAME', 'set Name = "
                      "value' and 'end' on lines of their own.");
    assign(section, key, source, equals, set_in_file);
  }
  else if (starts_with(line, "include", rest) || line.rfind("Include", 0) == 0)
    throw UserError(place +
                    ": 'include' is not supported. Copy the lines, or use --set on the command line.");
  else
  {
    source.refuse_foreign_characters();
    throw UserError(place + ": the line " + in_quotes(line) + " cannot be understood. " +
                    advice_for_line(line, section, schema));
  }
}

void StrictParser::parse_override(const std::string &assignment)
{
  const std::string place = command_line;
  const std::string::size_type equals = assignment.find('=');
  const std::string value =
      equals == std::string::npos ? "" : dealii::Utilities::trim(assignment.substr(equals + 1));

  // The run writes its parameters down as a file, which has to hold the value.
  std::string flaw = flaw_of_text(assignment);
  if (flaw.empty() && value.find('#') != std::string::npos)
    flaw = "holds a '#', which begins a comment in parameter files";
  if (flaw.empty() && !value.empty() && value.back() == '\\')
    flaw = "ends with a backslash, which continues a line in parameter files";
  if (!flaw.empty())
    throw UserError(place + ": " + in_quotes(assignment) + " " + flaw + ". Choose another value.");
  refuse_invisible_characters(assignment, place);
  const SourceLine source(assignment);

  if (equals == std::string::npos)
  {
    source.refuse_foreign_characters();
    throw UserError(place + ": --set " + in_quotes(assignment) +
                    " has no '='. Write --set \"Section/Name=value\", for example --set \"Fluid/Capillary "
                    "number=0.5\".");
  }
  if (dealii::Utilities::trim(assignment.substr(0, equals)).empty())
    throw UserError(place + ": --set " + in_quotes(assignment) +
                    " names no parameter. Write --set \"Section/Name=value\".");

  std::string section;
  const auto [sections, key] = Schema::split(assignment.substr(0, equals));
  std::istringstream stream(sections);
  for (std::string name; std::getline(stream, name, '/');)
  {
    name = normalise(name);
    if (!schema.has_section(Schema::join(section, name)))
    {
      source.refuse_foreign_characters(0, equals);
      unknown_section(section, name, place);
    }
    section = Schema::join(section, name);
  }
  if (!sections.empty() && sections.back() == '/') // getline() does not see the empty name at the end
    unknown_section(section, "", place);
  assign(section, normalise(key), source, equals, set_on_command_line);
}

std::map<std::string, std::string> StrictParser::places() const
{
  // insert() keeps what is there: the command line has the last word.
  std::map<std::string, std::string> result = set_on_command_line;
  result.insert(set_in_file.begin(), set_in_file.end());
  return result;
}

void StrictParser::enter(const std::string &name, const SourceLine &source)
{
  const std::string &place = source.place();
  const std::string section = open_sections.empty() ? "" : open_sections.back().path;
  if (name.empty())
    throw UserError(place +
                    ": this 'subsection' has no name. Write 'subsection NAME', for example 'subsection "
                    "Fluid'.");
  if (name.find('/') != std::string::npos)
    throw UserError(place + ": the name " + in_quotes(name) +
                    " has a '/', as on the command line. In a file write a line 'subsection NAME' and an "
                    "'end' for each part.");
  if (!schema.has_section(Schema::join(section, name)))
  {
    source.refuse_foreign_characters();
    unknown_section(section, name, place);
  }
  open_sections.push_back({Schema::join(section, name), place});
}

void StrictParser::assign(const std::string &section, const std::string &key, const SourceLine &source,
                          const std::string::size_type equals,
                          std::map<std::string, std::string> &already_set)
{
  const std::string &place = source.place();
  const std::string value = dealii::Utilities::trim(source.text().substr(equals + 1));
  const std::string path = Schema::join(section, key);
  const auto entry = schema.entries().find(path);
  if (entry == schema.entries().end())
  {
    source.refuse_foreign_characters(0, equals);
    unknown_key(section, key, place);
  }
  if (const auto earlier = already_set.find(path); earlier != already_set.end())
    throw UserError(place + ": the parameter '" + path + "' is given twice" +
                    (place != command_line        ? ", first at " + earlier->second
                     : path == "Output directory" ? " (--output sets it, too)"
                                                  : "") +
                    ". Remove one of them.");

  unsigned int depth = 0;
  std::istringstream stream(section);
  for (std::string name; std::getline(stream, name, '/'); ++depth)
    prm.enter_subsection(name);
  bool allowed = true;
  try
  {
    prm.set(key, value);
  }
  catch (const dealii::ParameterHandler::ExcValueDoesNotMatchPattern &)
  {
    allowed = false;
  }
  for (; depth > 0; --depth)
    prm.leave_subsection();
  // An expression is text of any kind for ParameterHandler.
  if (!allowed || entry->second.allowed.find("expression") != std::string::npos)
    source.refuse_foreign_characters(equals + 1);
  if (!allowed)
  {
    const std::string similar = nearest(value, choices(entry->second.allowed));
    throw UserError(place + ": the value " + in_quotes(value) + " of the parameter '" + path +
                    "' is not allowed; expected " + entry->second.allowed + "." +
                    (similar.empty() ? "" : " Did you mean '" + similar + "'?"));
  }
  already_set[path] = place;
}

void StrictParser::unknown_key(const std::string &section, const std::string &key,
                               const std::string &place) const
{
  std::string remedy;
  const std::vector<std::string> keys = schema.keys(section);
  const std::string similar = nearest(key, keys);
  const std::vector<std::string> holders = schema.holders_of_key(key);
  if (!similar.empty())
    remedy = "Did you mean '" + similar + "' (" +
             schema.entries().at(Schema::join(section, similar)).allowed + ")?";
  else if (!holders.empty())
    remedy = "There is one " + in_section(holders.front()) +
             (place == command_line ? ": write '" + Schema::join(holders.front(), key) + "=...'."
                                    : "; is a 'subsection' or an 'end' missing?");
  else if (schema.has_section(Schema::join(section, key)))
    remedy = "This is the name of a section: write " +
             (place == command_line ? "'" + Schema::join(section, key) + "/NAME=value'."
                                    : "'subsection " + key + "' and its parameters, then 'end'.");
  else
  {
    // A typo in a parameter that belongs elsewhere.
    std::vector<std::string> all_keys;
    for (const auto &[path, entry] : schema.entries())
      all_keys.push_back(Schema::split(path).second);
    const std::string elsewhere = nearest(key, all_keys);
    if (!elsewhere.empty())
      remedy =
          "Did you mean '" + elsewhere + "' " + in_section(schema.holders_of_key(elsewhere).front()) + "?";
    else
      remedy = keys.empty() ? "There are only sections here: " + list(schema.subsections(section)) + "."
                            : "The parameters here are " + list(keys) + ".";
  }
  throw UserError(place + ": there is no parameter " + in_quotes(key) + " " + in_section(section) + ". " +
                  remedy);
}

void StrictParser::unknown_section(const std::string &section, const std::string &name,
                                   const std::string &place) const
{
  std::string remedy;
  const std::vector<std::string> sections = schema.subsections(section);
  const std::string similar = nearest(name, sections);
  const std::vector<std::string> holders = schema.holders_of_section(name);
  if (!similar.empty())
    remedy = "Did you mean '" + similar + "'?";
  else if (!holders.empty() && !open_sections.empty())
    remedy = "There is one " + in_section(holders.front()) +
             "; is an 'end' missing for the section that starts at " + open_sections.back().place + "?";
  else if (!holders.empty())
    remedy = "There is one " + in_section(holders.front()) + ": open that section first.";
  else
    remedy =
        sections.empty() ? "There are no sections here." : "The sections here are " + list(sections) + ".";
  throw UserError(place + ": there is no section " + in_quotes(name) + " " + in_section(section) + ". " +
                  remedy);
}
} // namespace Gemmule::Parameters
