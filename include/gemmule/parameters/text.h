// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace Gemmule::Parameters
{
/** The text for a message: without its middle when it is longer than a line. */
std::string shortened(const std::string &text);

/** The same, printable, in single quotes. */
std::string in_quotes(const std::string &text);

/** The number as a message shows it: with few digits, which are enough to find a place or a time. */
std::string short_number(double number, unsigned int digits = 3);

/** The text with control characters, which could garble a terminal, written as "\xNN", and with characters
 * that cannot be seen written as <U+00A0>. */
std::string printable(const std::string &text);

/**
 * What keeps the text from standing in a parameter file: "" if nothing does, else the end of a sentence that
 * begins with what the text is, for example "holds the control character \x07".
 */
std::string flaw_of_text(const std::string &text);
} // namespace Gemmule::Parameters
