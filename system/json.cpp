// SPDX-License-Identifier: MIT
#include "system/json.h"

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>

#include "core/printable.h"

namespace wholehand {
namespace {

// The writer escapes control characters of ASCII. Others that steer a terminal or a page (core/printable.h) stand in strings alone, and are escaped
// there.
std::string escaped(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (std::string_view rest = json; !rest.empty();) {
    const Utf8Character character = first_character(rest);
    if (character.code >= 0x7F && is_steering(character.code)) {
      safe += fmt::format("\\u{:04x}", static_cast<std::uint32_t>(character.code));
    } else {
      safe += rest.substr(0, character.length);
    }
    rest.remove_prefix(character.length);
  }
  return safe;
}

}  // namespace

nlohmann::json parse_json(std::string_view text) { return nlohmann::json::parse(text); }

nlohmann::ordered_json parse_ordered_json(std::string_view text) { return nlohmann::ordered_json::parse(text); }

nlohmann::json try_json(std::string_view text) { return nlohmann::json::parse(text, nullptr, false); }

std::string json_text(const nlohmann::json& value, int indent) {
  return escaped(value.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace));
}

std::string json_text(const nlohmann::ordered_json& value, int indent) {
  return escaped(value.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace wholehand
