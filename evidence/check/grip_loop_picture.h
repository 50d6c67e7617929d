// SPDX-License-Identifier: MIT
// A picture of which users hold, and which shake.
#pragma once

#include <string>

namespace wholehand {

// A picture as SVG: what becomes of a user of slow or quick reaction, over k_open, with the limits of theory as lines.
std::string grip_loop_picture();

}  // namespace wholehand
