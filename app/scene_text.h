// Names and texts from outside, for messages.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "app/scene_ranges.h"

namespace wholehand {

// Control characters as \xNN.
std::string one_line(std::string_view text);

// `text` in single quotes on one line, cut after 60 bytes (never inside a character).
std::string in_quotes(std::string_view text);

// Name of `names` with the smallest edit distance to `name`, the first of equally near ones; "" where there are none.
std::string nearest_name(std::string_view name, std::span<const std::string_view> names);

// Whether a name fits result files and file names: a letter, then letters, digits, '_', '-' or '.', at most LARGEST_NAME in all.
bool is_plain_name(std::string_view name);

// "0 to 100".
std::string describe(const Quantity& quantity);

}  // namespace wholehand
