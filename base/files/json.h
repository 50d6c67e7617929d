// SPDX-License-Identifier: MIT
// JSON to and from text. nlohmann's own reader and writer are templates, and cost every file that calls them 0.8 s of compilation. Here
// they are compiled once (docs/results, "A bare Debian 12").
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace wholehand {

// The value of a text. Throws nlohmann::json::parse_error where it is not JSON.
nlohmann::json parse_json(std::string_view text);
nlohmann::ordered_json parse_ordered_json(std::string_view text);  // objects keep the order of their keys

// A value that is_discarded() where the text is not JSON.
nlohmann::json try_json(std::string_view text);

// The text of a value: on one line, or with `indent` spaces for each level. A name of a file may have any bytes: those that are not UTF-8
// become U+FFFD. Characters that steer and are not seen are escaped. A zero has no sign.
std::string json_text(const nlohmann::json& value, int indent = -1);
std::string json_text(const nlohmann::ordered_json& value, int indent = -1);

}  // namespace wholehand
