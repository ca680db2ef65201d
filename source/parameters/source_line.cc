// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/base/exceptions.h>
#include <gemmule/parameters/characters.h>
#include <gemmule/parameters/source_line.h>
#include <gemmule/parameters/text.h>

namespace Gemmule::Parameters
{
namespace
{
  const std::string command_line = "command line";

  [[noreturn]] void refuse(const ForeignCharacter &character, const unsigned int column,
                           const std::string &line, const std::string &place)
  {
    const std::string which = place == command_line ? "character " : "column ";
    throw UserError(place + ": " + which + std::to_string(column) + " of " + in_quotes(line) +
                    (place == command_line ? " is " : " holds ") + character.name + ". " + character.remedy);
  }
} // namespace

void SourceLine::append(const std::string &line, const std::string::size_type begin,
                        const std::string::size_type end, const std::string &place)
{
  if (pieces.empty())
    first_place = place;
  if (!content.empty())
    content += ' ';
  pieces.push_back({content.size(), begin, line, place});
  content += line.substr(begin, end - begin);
}

void SourceLine::refuse_foreign_characters(const std::string::size_type begin,
                                           const std::string::size_type end) const
{
  const auto character = find_foreign_character(content.substr(begin, end - begin));
  if (!character)
    return;
  const std::string::size_type position = begin + character->position;
  if (pieces.empty())
    refuse(*character, n_characters(content.substr(0, position)) + 1, content, first_place);
  const Piece *piece = &pieces.front();
  for (const Piece &candidate : pieces)
    if (candidate.begin <= position)
      piece = &candidate;
  refuse(*character, n_characters(piece->line.substr(0, piece->begin_in_line + position - piece->begin)) + 1,
         piece->line, piece->place);
}

void refuse_invisible_characters(const std::string &line, const std::string &place)
{
  if (const auto character = find_invisible_character(line))
    refuse(*character, character->column, line, place);
}
} // namespace Gemmule::Parameters
