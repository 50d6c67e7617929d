// SPDX-License-Identifier: MIT
// Text from outside, as it may be shown: names, keys and strings of files, paths, and what devices and drivers call themselves. A terminal obeys
// characters that nobody sees, and a page or a table turns its words round for some of them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace wholehand {

// What a text begins with.
struct Utf8Character {
  char32_t code = 0;
  std::size_t length = 1;  // bytes
  bool is_whole = false;   // false: the first byte begins no character of UTF-8, and is alone
};

// `text` is not empty.
Utf8Character first_character(std::string_view text);

// Whether a character steers and is not seen: a control character (U+0000 to U+001F, U+007F to U+009F), a line or paragraph separator, or a mark
// that sets or turns the direction of writing.
bool is_steering(char32_t code);

// `text` with every character that steers as \xNN or \uNNNN, and every byte that is no UTF-8 as \xNN, on one line.
std::string one_line(std::string_view text);

// The same for text of several lines: line feeds and tabs stay.
std::string printable_lines(std::string_view text);

}  // namespace wholehand
