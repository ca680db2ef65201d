// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gemmule/parameters/characters.h>
#include <gemmule/parameters/text.h>

#include <cstdio>
#include <sstream>

namespace Gemmule::Parameters
{
namespace
{
  bool is_control_character(const unsigned char c)
  {
    return c < 0x20 || c == 0x7f;
  }

  std::string escaped(const unsigned char c)
  {
    char buffer[8];
    std::snprintf(buffer, sizeof(buffer), "\\x%02X", c);
    return buffer;
  }

  bool is_continuation_byte(const unsigned char c)
  {
    return (c & 0xC0) == 0x80;
  }

  /** Position of the first byte that does not belong to a UTF-8 character, or npos. */
  std::string::size_type find_invalid_utf8(const std::string &text)
  {
    for (std::string::size_type i = 0; i < text.size();)
    {
      const unsigned char first = text[i];
      unsigned int n_more = 0;
      if (first >= 0xC2 && first <= 0xDF)
        n_more = 1;
      else if (first >= 0xE0 && first <= 0xEF)
        n_more = 2;
      else if (first >= 0xF0 && first <= 0xF4)
        n_more = 3;
      else if (first >= 0x80)
        return i;
      for (unsigned int k = 1; k <= n_more; ++k)
        if (i + k >= text.size() || !is_continuation_byte(text[i + k]))
          return i;
      if (n_more > 1)
      {
        // overlong forms, halves of surrogate pairs, and what lies beyond the last character
        const unsigned char second = text[i + 1];
        if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F) ||
            (first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F))
          return i;
      }
      i += n_more + 1;
    }
    return std::string::npos;
  }
} // namespace

std::string shortened(const std::string &text)
{
  constexpr std::string::size_type most = 160, head = 100, tail = 20;
  if (text.size() <= most)
    return text;
  // Characters are not cut in two.
  std::string::size_type end = head, begin = text.size() - tail;
  while (end > 0 && is_continuation_byte(text[end]))
    --end;
  while (begin < text.size() && is_continuation_byte(text[begin]))
    ++begin;
  return text.substr(0, end) + "[...]" + text.substr(begin);
}

std::string in_quotes(const std::string &text)
{
  // A zero byte would end the message of an exception.
  return "'" + printable(shortened(text)) + "'";
}

std::string short_number(const double number, const unsigned int digits)
{
  std::ostringstream text;
  text.precision(digits);
  text << number;
  return text.str();
}

std::string printable(const std::string &text)
{
  std::string result;
  for (const char c : text)
    result += is_control_character(c) ? escaped(c) : std::string(1, c);
  // Marks of the writing direction would turn the message around.
  return with_visible_characters(result);
}

std::string flaw_of_text(const std::string &text)
{
  for (const char c : text)
    if (is_control_character(c) && c != '\t')
      return "holds the control character " + escaped(c);
  const auto invalid = find_invalid_utf8(text);
  if (invalid != std::string::npos)
    return "holds the byte " + escaped(text[invalid]) + ", which is no UTF-8 text";
  return "";
}
} // namespace Gemmule::Parameters
