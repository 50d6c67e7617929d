// SPDX-License-Identifier: MIT
// Builds text. fmt offers both functions, but as templates that each file compiles anew: fmt::join costs 0.3 s, and fmt::format_to with a
// std::back_inserter 1.5 s, because it includes the whole formatter (docs/results, "A bare Debian 12").
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace wholehand {

// Joins words, with the separator between any two. A word is a std::string, a std::string_view or a const char*.
template <class Words>
std::string joined(const Words& words, std::string_view separator) {
  std::string text;
  bool is_first = true;
  for (const auto& word : words) {
    if (!is_first) text += separator;
    is_first = false;
    text += std::string_view(word);
  }
  return text;
}

// Appends the result of fmt::format with the same arguments.
template <class... Args>
void append_formatted(std::string& text, fmt::format_string<Args...> format, Args&&... args) {
  text += fmt::vformat(format, fmt::make_format_args(args...));
}

}  // namespace wholehand
