// SPDX-License-Identifier: MIT
// Makes outside text safe to show: names, keys and strings from files, paths, and what devices and drivers call themselves. Terminals obey invisible
// characters, and some of these reverse words in a page or a table.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace wholehand {

// The first character of a text.
struct Utf8Character {
  char32_t code = 0;
  std::size_t length = 1;  // bytes
  bool is_whole = false;   // false: the first byte does not begin a UTF-8 character, and stands alone
};

// `text` is not empty.
Utf8Character first_character(std::string_view text);

// Whether a character is an invisible control: a control character (U+0000 to U+001F, U+007F to U+009F), a line or paragraph separator, or a mark
// that changes the direction of writing.
bool is_steering(char32_t code);

// `text` on one line, with every control as \xNN or \uNNNN, and every byte that is not UTF-8 as \xNN.
std::string one_line(std::string_view text);

// The same for text of several lines: line feeds and tabs stay.
std::string printable_lines(std::string_view text);

}  // namespace wholehand
