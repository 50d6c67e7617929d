// SPDX-License-Identifier: MIT
// Prepares names and texts from outside for messages.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/text/nearest_name.h"
#include "core/reader/ranges.h"

namespace wholehand {

// `text` in single quotes on one line, cut after 60 bytes (never inside a character).
std::string in_quotes(std::string_view text);

// Whether a name fits result files and file names: a letter, then letters, digits, '_', '-' or '.', at most LARGEST_NAME in all.
bool is_plain_name(std::string_view name);

// "0 to 100".
std::string describe(const Quantity& quantity);

}  // namespace wholehand
