// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string>

namespace Gemmule::Parameters
{
/** A character that is not what it seems to be, in a text. */
struct ForeignCharacter
{
  /** Its first byte. */
  std::string::size_type position;
  /** Which character of the text it is, from 1. */
  unsigned int column;
  /** For example "a no-break space (U+00A0)" or "'−' (minus sign, U+2212)". */
  std::string name;
  /** What to do, as a sentence, for example "Write '-'." */
  std::string remedy;
};

/**
 * The first character that cannot be seen, or cannot be told from a blank: spaces other than the blank,
 * characters without width, marks of the writing direction, line separators of Unicode. The text is UTF-8.
 */
std::optional<ForeignCharacter> find_invisible_character(const std::string &text);

/** The first character beyond ASCII, invisible or not: where only letters, digits and signs of the keyboard
 * are understood. */
std::optional<ForeignCharacter> find_foreign_character(const std::string &text);

/** Number of characters of a text in UTF-8. */
unsigned int n_characters(const std::string &text);

/** The text with its invisible characters written as <U+00A0>. */
std::string with_visible_characters(const std::string &text);
} // namespace Gemmule::Parameters
