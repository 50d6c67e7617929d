// SPDX-License-Identifier: MIT
#include "base/text/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>

namespace wholehand {
namespace {

struct CodeRange {
  char32_t first, last;
};
constexpr CodeRange STEERING[] = {{0, 0x1F},        {0x7F, 0x9F},     {0x61C, 0x61C},  // controls; Arabic letter mark
                                  {0x200E, 0x200F}, {0x2028, 0x2029},   // left-to-right and right-to-left marks; separators
                                  {0x202A, 0x202E}, {0x2066, 0x2069}};  // embeddings, overrides, isolates

std::string shown(std::string_view text, bool has_lines) {
  std::string line;
  line.reserve(text.size());
  while (!text.empty()) {
    const Utf8Character character = first_character(text);
    const bool stays = has_lines && (text[0] == '\n' || text[0] == '\t');
    if (!character.is_whole || (character.code < 0x80 && is_steering(character.code) && !stays)) {
      line += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(text[0]));
    } else if (is_steering(character.code) && !stays) {
      line += fmt::format("\\u{:04x}", static_cast<std::uint32_t>(character.code));
    } else {
      line += text.substr(0, character.length);
    }
    text.remove_prefix(character.length);
  }
  return line;
}

}  // namespace

Utf8Character first_character(std::string_view text) {
  const auto byte = [text](std::size_t i) { return i < text.size() ? static_cast<std::uint8_t>(text[i]) : 0U; };
  const std::uint32_t lead = byte(0);
  const std::size_t length = lead < 0x80                   ? 1
                             : lead >= 0xC2 && lead < 0xE0 ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  if (length == 0) return {};
  std::uint32_t code = length == 1 ? lead : lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return {};
    code = code << 6 | (byte(i) & 0x3FU);
  }
  const bool is_shortest = length < 3 || code >= (length == 3 ? 0x800U : 0x10000U);
  const bool is_half_of_a_pair = code >= 0xD800 && code < 0xE000;
  if (!is_shortest || is_half_of_a_pair || code > 0x10FFFF) return {};
  return {code, length, true};
}

bool is_steering(char32_t code) {
  return std::any_of(std::begin(STEERING), std::end(STEERING),
                     [code](const CodeRange& range) { return code >= range.first && code <= range.last; });
}

std::string one_line(std::string_view text) { return shown(text, false); }

std::string printable_lines(std::string_view text) { return shown(text, true); }

}  // namespace wholehand
