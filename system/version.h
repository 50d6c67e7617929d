// SPDX-License-Identifier: MIT
// The program's version.
#pragma once

namespace wholehand {

// "0.1.0", from the build.
const char* version();

}  // namespace wholehand
