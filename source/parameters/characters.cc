// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/characters.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>

namespace Gemmule::Parameters
{
namespace
{
  using Position = std::string::size_type;
  using CodePoint = std::uint32_t;

  /** The character at @p position, which moves behind it. Bytes that are no UTF-8 stand for themselves. */
  CodePoint next_character(const std::string &text, Position &position)
  {
    const unsigned char first = text[position++];
    const unsigned int n_more = first >= 0xF0 ? 3 : first >= 0xE0 ? 2 : first >= 0xC0 ? 1 : 0;
    if (n_more == 0)
      return first < 0x80 ? first : 0xFFFD;
    CodePoint value = first & (0x3F >> n_more);
    for (unsigned int i = 0; i < n_more; ++i)
    {
      if (position >= text.size() || (static_cast<unsigned char>(text[position]) & 0xC0) != 0x80)
        return 0xFFFD;
      value = (value << 6) | (static_cast<unsigned char>(text[position++]) & 0x3F);
    }
    return value;
  }

  std::string code(const CodePoint c)
  {
    char buffer[16];
    std::snprintf(buffer, sizeof(buffer), "U+%04X", static_cast<unsigned int>(c));
    return buffer;
  }

  enum class Looks
  {
    like_a_blank,
    like_nothing,
    like_a_new_line
  };

  struct Invisible
  {
    CodePoint first, last;
    Looks looks;
    const char *name;
  };

  /** Names as in the Unicode standard. */
  constexpr std::array<Invisible, 40> invisible_characters{{
      {0x0080, 0x0084, Looks::like_nothing, "a control character"},
      {0x0085, 0x0085, Looks::like_a_new_line, "a next-line character"},
      {0x0086, 0x009F, Looks::like_nothing, "a control character"},
      {0x00A0, 0x00A0, Looks::like_a_blank, "a no-break space"},
      {0x00AD, 0x00AD, Looks::like_nothing, "a soft hyphen"},
      {0x034F, 0x034F, Looks::like_nothing, "a combining grapheme joiner"},
      {0x061C, 0x061C, Looks::like_nothing, "an Arabic letter mark"},
      {0x115F, 0x1160, Looks::like_a_blank, "a Hangul filler"},
      {0x1680, 0x1680, Looks::like_a_blank, "an ogham space mark"},
      {0x180B, 0x180E, Looks::like_nothing, "a Mongolian separator"},
      {0x2000, 0x2000, Looks::like_a_blank, "an en quad"},
      {0x2001, 0x2001, Looks::like_a_blank, "an em quad"},
      {0x2002, 0x2002, Looks::like_a_blank, "an en space"},
      {0x2003, 0x2003, Looks::like_a_blank, "an em space"},
      {0x2004, 0x2004, Looks::like_a_blank, "a three-per-em space"},
      {0x2005, 0x2005, Looks::like_a_blank, "a four-per-em space"},
      {0x2006, 0x2006, Looks::like_a_blank, "a six-per-em space"},
      {0x2007, 0x2007, Looks::like_a_blank, "a figure space"},
      {0x2008, 0x2008, Looks::like_a_blank, "a punctuation space"},
      {0x2009, 0x2009, Looks::like_a_blank, "a thin space"},
      {0x200A, 0x200A, Looks::like_a_blank, "a hair space"},
      {0x200B, 0x200B, Looks::like_nothing, "a zero-width space"},
      {0x200C, 0x200C, Looks::like_nothing, "a zero-width non-joiner"},
      {0x200D, 0x200D, Looks::like_nothing, "a zero-width joiner"},
      {0x200E, 0x200F, Looks::like_nothing, "a mark of the writing direction"},
      {0x2028, 0x2029, Looks::like_a_new_line, "a line or paragraph separator"},
      {0x202A, 0x202E, Looks::like_nothing, "a mark of the writing direction"},
      {0x202F, 0x202F, Looks::like_a_blank, "a narrow no-break space"},
      {0x205F, 0x205F, Looks::like_a_blank, "a medium mathematical space"},
      {0x2060, 0x2060, Looks::like_nothing, "a word joiner"},
      {0x2061, 0x2065, Looks::like_nothing, "an invisible operator"},
      {0x2066, 0x206F, Looks::like_nothing, "a mark of the writing direction"},
      {0x2800, 0x2800, Looks::like_a_blank, "a blank Braille pattern"},
      {0x3000, 0x3000, Looks::like_a_blank, "an ideographic space"},
      {0x3164, 0x3164, Looks::like_a_blank, "a Hangul filler"},
      {0xFE00, 0xFE0F, Looks::like_nothing, "a variation selector"},
      {0xFEFF, 0xFEFF, Looks::like_nothing, "a byte order mark"},
      {0xFFA0, 0xFFA0, Looks::like_a_blank, "a halfwidth Hangul filler"},
      {0xFFF9, 0xFFFB, Looks::like_nothing, "an annotation mark"},
      {0xE0000, 0xE0FFF, Looks::like_nothing, "a tag or variation selector"},
  }};

  const Invisible *find_invisible(const CodePoint c)
  {
    if (c < 0x80)
      return nullptr;
    const auto found =
        std::find_if(invisible_characters.begin(), invisible_characters.end(),
                     [c](const Invisible &range) { return range.first <= c && c <= range.last; });
    return found == invisible_characters.end() ? nullptr : &*found;
  }

  struct LookAlike
  {
    CodePoint first, last;
    const char *name;
    /** What to write instead; of a range, that for the first. */
    const char *instead;
  };

  /** What word processors, web pages and formulas have in the place of what the keyboard has. */
  constexpr std::array<LookAlike, 66> look_alikes{{
      {0x00B2, 0x00B2, "superscript two", "^2"},
      {0x00B3, 0x00B3, "superscript three", "^3"},
      {0x00B9, 0x00B9, "superscript one", "^1"},
      {0x2070, 0x2070, "superscript zero", "^0"},
      {0x2074, 0x2074, "superscript four", "^4"},
      {0x2075, 0x2075, "superscript five", "^5"},
      {0x2076, 0x2076, "superscript six", "^6"},
      {0x2077, 0x2077, "superscript seven", "^7"},
      {0x2078, 0x2078, "superscript eight", "^8"},
      {0x2079, 0x2079, "superscript nine", "^9"},
      {0x207B, 0x207B, "superscript minus", "^(-...)"},
      {0x00BC, 0x00BC, "one quarter", "1/4"},
      {0x00BD, 0x00BD, "one half", "1/2"},
      {0x00BE, 0x00BE, "three quarters", "3/4"},
      {0x2010, 0x2010, "hyphen", "-"},
      {0x2011, 0x2011, "non-breaking hyphen", "-"},
      {0x2012, 0x2012, "figure dash", "-"},
      {0x2013, 0x2013, "en dash", "-"},
      {0x2014, 0x2014, "em dash", "-"},
      {0x2015, 0x2015, "horizontal bar", "-"},
      {0x2212, 0x2212, "minus sign", "-"},
      {0xFE63, 0xFE63, "small hyphen-minus", "-"},
      {0x00D7, 0x00D7, "multiplication sign", "*"},
      {0x00B7, 0x00B7, "middle dot", "*"},
      {0x2022, 0x2022, "bullet", "*"},
      {0x2217, 0x2217, "asterisk operator", "*"},
      {0x2219, 0x2219, "bullet operator", "*"},
      {0x22C5, 0x22C5, "dot operator", "*"},
      {0x2715, 0x2715, "multiplication sign", "*"},
      {0x00F7, 0x00F7, "division sign", "/"},
      {0x2044, 0x2044, "fraction slash", "/"},
      {0x2215, 0x2215, "division slash", "/"},
      {0x2236, 0x2236, "ratio", "/"},
      {0x02C6, 0x02C6, "circumflex accent", "^"},
      {0x2264, 0x2264, "less-than or equal to", "<="},
      {0x2A7D, 0x2A7D, "less-than or slanted equal to", "<="},
      {0x2265, 0x2265, "greater-than or equal to", ">="},
      {0x2A7E, 0x2A7E, "greater-than or slanted equal to", ">="},
      {0x2260, 0x2260, "not equal to", "!="},
      {0x2227, 0x2227, "logical and", "&&"},
      {0x2228, 0x2228, "logical or", "||"},
      {0x00AC, 0x00AC, "not sign", "!"},
      {0x221A, 0x221A, "square root", "sqrt(...)"},
      {0x03C0, 0x03C0, "Greek letter pi", "pi"},
      {0x1D70B, 0x1D70B, "mathematical letter pi", "pi"},
      {0x2018, 0x201B, "curly quotation mark", "'"},
      {0x201C, 0x201F, "curly quotation mark", "\""},
      {0x2032, 0x2033, "prime", "'"},
      {0x2026, 0x2026, "ellipsis", "..."},
      {0x0445, 0x0445, "Cyrillic letter ha", "x"},
      {0x0443, 0x0443, "Cyrillic letter u", "y"},
      {0x0430, 0x0430, "Cyrillic letter a", "a"},
      {0x0435, 0x0435, "Cyrillic letter ie", "e"},
      {0x043E, 0x043E, "Cyrillic letter o", "o"},
      {0x0440, 0x0440, "Cyrillic letter er", "p"},
      {0x0441, 0x0441, "Cyrillic letter es", "c"},
      {0x0421, 0x0421, "Cyrillic capital letter es", "C"},
      {0x041C, 0x041C, "Cyrillic capital letter em", "M"},
      {0x0456, 0x0456, "Cyrillic letter i", "i"},
      {0x0455, 0x0455, "Cyrillic letter dze", "s"},
      {0x03C7, 0x03C7, "Greek letter chi", "x"},
      {0x03BF, 0x03BF, "Greek letter omicron", "o"},
      {0x03BD, 0x03BD, "Greek letter nu", "v"},
      {0x039C, 0x039C, "Greek capital letter mu", "M"},
      {0x3001, 0x3001, "ideographic comma", ","},
      {0x066B, 0x066B, "Arabic decimal separator", "."},
  }};

  struct Description
  {
    std::string name, instead;
  };

  /** Name and replacement of a character that can be seen; both empty if there is nothing to say. */
  Description describe_visible(const CodePoint c)
  {
    // Blocks whose characters are in the order of ASCII.
    if (c >= 0xFF01 && c <= 0xFF5E)
      return {"fullwidth character", std::string(1, static_cast<char>(c - 0xFF01 + '!'))};
    if (c >= 0x2080 && c <= 0x2089)
      return {"subscript digit", std::string(1, static_cast<char>(c - 0x2080 + '0'))};
    if (c >= 0x1D400 && c <= 0x1D6A3)
    {
      const unsigned int letter = (c - 0x1D400) % 52;
      return {"mathematical letter",
              std::string(1, static_cast<char>(letter < 26 ? 'A' + letter : 'a' + letter - 26))};
    }
    if (c >= 0x1D7CE && c <= 0x1D7FF)
      return {"mathematical digit", std::string(1, static_cast<char>('0' + (c - 0x1D7CE) % 10))};
    for (const LookAlike &entry : look_alikes)
      if (entry.first <= c && c <= entry.last)
        return {entry.name, entry.instead};
    return {"", ""};
  }

  ForeignCharacter describe(const std::string &text, const Position position, const Position behind,
                            const unsigned int column, const CodePoint c)
  {
    const auto is_digit = [&](const Position i)
    { return i < text.size() && text[i] >= '0' && text[i] <= '9'; };
    const bool groups_digits = position > 0 && is_digit(position - 1) && is_digit(behind);
    if (const Invisible *const invisible = find_invisible(c))
      return {position, column, std::string(invisible->name) + " (" + code(c) + ")",
              groups_digits                             ? "Delete it: there are no blanks in numbers."
              : invisible->looks == Looks::like_a_blank ? "Put a blank in its place."
              : invisible->looks == Looks::like_nothing ? "Delete it; it cannot be seen in most editors."
                                                        : "Begin a new line there with the Enter key."};
    const std::string shown = "'" + text.substr(position, behind - position) + "'";
    const auto [name, instead] = describe_visible(c);
    return {position, column, shown + " (" + (name.empty() ? "" : name + ", ") + code(c) + ")",
            instead.empty() ? "Only the letters, digits and signs of ASCII are understood here."
            : name.find("quotation") != std::string::npos ? "Delete it: no quotation marks are needed here."
                                                          : "Write '" + instead + "'."};
  }
} // namespace

std::optional<ForeignCharacter> find_invisible_character(const std::string &text)
{
  unsigned int column = 1;
  for (Position i = 0; i < text.size(); ++column)
  {
    const Position begin = i;
    const CodePoint c = next_character(text, i);
    if (find_invisible(c) != nullptr)
      return describe(text, begin, i, column, c);
  }
  return {};
}

std::optional<ForeignCharacter> find_foreign_character(const std::string &text)
{
  unsigned int column = 1;
  for (Position i = 0; i < text.size(); ++column)
  {
    const Position begin = i;
    const CodePoint c = next_character(text, i);
    if (c >= 0x80)
      return describe(text, begin, i, column, c);
  }
  return {};
}

unsigned int n_characters(const std::string &text)
{
  unsigned int n = 0;
  for (Position i = 0; i < text.size(); ++n)
    next_character(text, i);
  return n;
}

std::string with_visible_characters(const std::string &text)
{
  std::string result;
  for (Position i = 0; i < text.size();)
  {
    const Position begin = i;
    const CodePoint c = next_character(text, i);
    result += find_invisible(c) != nullptr ? "<" + code(c) + ">" : text.substr(begin, i - begin);
  }
  return result;
}
} // namespace Gemmule::Parameters
