// SPDX-License-Identifier: MIT
// JSON to and from text. nlohmann's reader and writer are templates that cost each calling file 0.8 s of compilation, so they are compiled once, here
// (docs/results, "A bare Debian 12").
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace wholehand {

// The value of a text. Throws nlohmann::json::parse_error if it is not JSON.
nlohmann::json parse_json(std::string_view text);
nlohmann::ordered_json parse_ordered_json(std::string_view text);  // objects keep the order of their keys

// The value of a text; is_discarded() is true if it is not JSON.
nlohmann::json try_json(std::string_view text);

// The text of a value: on one line, or with `indent` spaces for each level. Bytes that are not UTF-8, as file names may have, become U+FFFD.
// Invisible control characters are escaped. Zero has no sign.
std::string json_text(const nlohmann::json& value, int indent = -1);
std::string json_text(const nlohmann::ordered_json& value, int indent = -1);

}  // namespace wholehand
