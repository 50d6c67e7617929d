// SPDX-License-Identifier: MIT
// A picture of who holds, and who shakes.
#pragma once

#include <string>

namespace wholehand {

// Its text: what becomes of a user of slow or quick reaction, over k_open, with the limits of theory as lines.
std::string grip_loop_picture();

}  // namespace wholehand
