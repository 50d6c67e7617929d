// SPDX-License-Identifier: MIT
// A picture of which users hold, and which oscillate.
#pragma once

#include <string>

namespace wholehand {

// A picture as SVG: the outcome for a user of slow or quick reaction, over k_open, with the theoretical limits as lines.
std::string grip_loop_picture();

}  // namespace wholehand
