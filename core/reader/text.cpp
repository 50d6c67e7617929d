// SPDX-License-Identifier: MIT
#include "core/reader/text.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text/printable.h"
#include "core/scene.h"

namespace wholehand {
namespace {

constexpr std::size_t LARGEST_QUOTE = 60;  // bytes

}  // namespace

double to_si(double value, Unit unit) {
  switch (unit) {
    case Unit::mm:
      return value / 1e3;
    case Unit::deg:
      return radians(value);
    case Unit::ml:
      return value / 1e6;
    case Unit::si:
      break;
  }
  return value;
}

std::string in_quotes(std::string_view text) {
  if (text.size() <= LARGEST_QUOTE) return fmt::format("'{}'", one_line(text));
  std::size_t end = LARGEST_QUOTE;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // whole UTF-8 characters
  return fmt::format("'{}...'", one_line(text.substr(0, end)));
}

bool is_plain_name(std::string_view name) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto is_plain = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.'; };
  return !name.empty() && name.size() <= ranges::LARGEST_NAME && is_letter(name[0]) &&
         std::all_of(name.begin(), name.end(), is_plain);
}

std::string describe(const Quantity& quantity) { return fmt::format("{} to {}", quantity.low, quantity.high); }

}  // namespace wholehand
