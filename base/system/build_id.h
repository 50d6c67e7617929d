// SPDX-License-Identifier: MIT
// Which build of the program this is.
#pragma once

#include <string>

namespace wholehand {

// The hash that the linker left in the running program, over everything in it, in hexadecimal digits; "unknown" where it left none.
std::string build_id();

}  // namespace wholehand
