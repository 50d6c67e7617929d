// SPDX-License-Identifier: MIT
// Parses values of a command line strictly: the whole text is the number, which is finite and in its range.
#pragma once

#include <string>

#include "core/backend.h"
#include "core/reader/ranges.h"
#include "core/scene.h"

namespace wholehand {

// `option` names the option in messages. Each throws Error (usage): `--option: what was found; what is allowed`.
double parse_quantity(const std::string& text, const std::string& option, const Quantity& quantity);  // in SI
Triple parse_triple(const std::string& text, const std::string& option, const Quantity& quantity);    // "x,y,z", in SI
std::int64_t parse_integer(const std::string& text, const std::string& option, IntegerRange range);
double parse_duration(const std::string& text, const std::string& option);  // "90", "1:30" or "0:01:30", in s; up to 99,999 hours
int parse_view_port(const std::string& text, bool has_view);                // "": 0, any; refuses a port without --view
Precision parse_precision(const std::string& text);                         // "float" or "double"

// The index of the vessel that --vessel names. Throws Error (usage), with the nearest name.
std::size_t find_vessel(const Scene& scene, const std::string& name);

}  // namespace wholehand
