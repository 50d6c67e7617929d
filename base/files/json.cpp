// SPDX-License-Identifier: MIT
#include "base/files/json.h"

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>

#include "base/text/printable.h"

namespace wholehand {
namespace {

// Whether a text begins with a zero that has a sign.
bool is_negative_zero(std::string_view json) { return json.starts_with("-0.0") && json.substr(4).find_first_of("0123456789") != 0; }

// Post-processes nlohmann's output, which escapes only ASCII control characters. Others that control a terminal or a page (base/text/printable.h)
// occur only in strings, and are escaped here. A zero loses its sign.
std::string finished(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  bool in_string = false;
  for (std::string_view rest = json; !rest.empty();) {
    if (!in_string && is_negative_zero(rest)) rest.remove_prefix(1);
    if (in_string && rest[0] == '\\') {  // and what it escapes, which may be a quote
      safe += rest.substr(0, 2);
      rest.remove_prefix(2);
      continue;
    }
    if (rest[0] == '"') in_string = !in_string;
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
  return finished(value.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace));
}

std::string json_text(const nlohmann::ordered_json& value, int indent) {
  return finished(value.dump(indent, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace wholehand
