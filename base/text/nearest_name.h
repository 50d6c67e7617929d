// SPDX-License-Identifier: MIT
// Suggests the name that a mistyped one may have meant.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wholehand {

// The name with the smallest edit distance to `name`; the first in a tie; "" if there are none.
std::string nearest_name(std::string_view name, std::span<const std::string_view> names);

// " (did you mean 'sweep'?)" if one of `names` begins with `name` or is a typing mistake away (a third of the characters), else "".
std::string did_you_mean(std::string_view name, std::span<const std::string_view> names);
std::string did_you_mean(std::string_view name, const std::vector<std::string>& names);

}  // namespace wholehand
