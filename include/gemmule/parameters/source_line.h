// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace Gemmule::Parameters
{
/**
 * A line of a parameter file, put together from those that a backslash continues, or an assignment of the
 * command line. It knows where its characters stand, for messages.
 */
class SourceLine
{
public:
  /** An assignment of the command line. */
  explicit SourceLine(const std::string &assignment) : content(assignment), first_place("command line") {}
  /** An empty line of a file. */
  SourceLine() = default;

  /**
   * Adds a line of a file.
   * @param line as it stands in the file
   * @param begin,end the part of it that is added: without comment, blanks at its ends and backslash
   * @param place for example "case.prm:12"
   */
  void append(const std::string &line, std::string::size_type begin, std::string::size_type end,
              const std::string &place);

  bool is_empty() const { return pieces.empty(); }
  const std::string &text() const { return content; }
  /** Where it begins: "case.prm:12" or "command line". */
  const std::string &place() const { return first_place; }

  /**
   * Looks between two bytes of text() for a character that the keyboard does not have.
   * @throws UserError that names it, its place and what to write instead; nothing happens if there is none
   */
  void refuse_foreign_characters(std::string::size_type begin = 0,
                                 std::string::size_type end = std::string::npos) const;

private:
  struct Piece
  {
    /** Where it begins in the text, and in its line. */
    std::string::size_type begin, begin_in_line;
    std::string line, place;
  };

  std::string content, first_place;
  std::vector<Piece> pieces;
};

/**
 * Looks for a character that cannot be seen or cannot be told from a blank.
 * @param place for example "case.prm:12"
 * @throws UserError that names it, its column and what to do; nothing happens if there is none
 */
void refuse_invisible_characters(const std::string &line, const std::string &place);
} // namespace Gemmule::Parameters
