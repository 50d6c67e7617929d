// SPDX-License-Identifier: MIT
// Identifies the build of the program.
#pragma once

#include <string>

namespace wholehand {

// The linker's hash of the whole running program, in hexadecimal digits; "unknown" if there is none.
std::string build_id();

}  // namespace wholehand
