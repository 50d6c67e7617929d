// SPDX-License-Identifier: MIT
// Parses the page's posts from JSON: docs/view.md.
#pragma once

#include <string_view>

#include "device/grippers/view_gripper.h"

namespace wholehand {

constexpr std::size_t LARGEST_CONTROL = 4096;  // bytes; a page's has some 400
constexpr double FURTHEST_CONTROL = 1000;      // m, each coordinate and the gap: larger values are meaningless
constexpr double CONTROL_SKEW = 0.01;          // how far columns may be from unit length and right angles

// A control from the body of a request: exactly the keys position, rotation, gap, buttons and sequence, all numbers finite and in their ranges. The
// rotation, which the page has in single precision, is made exact. Throws Error (usage): one line, what was found and what is allowed.
device::ViewControl parse_view_control(std::string_view body);

}  // namespace wholehand
