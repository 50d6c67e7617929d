// SPDX-License-Identifier: MIT
// Which build of the program this is.
#pragma once

#include <string>

namespace wholehand {

// The hash that the linker left in the running program, over everything in it, in hexadecimal digits; "unknown" where it left none.
std::string build_id();

// The file name of the running program and its build: "wholehand-sweep 155c253a..".
std::string build_name();

}  // namespace wholehand
