// SPDX-License-Identifier: MIT
// The program's version.
#pragma once

namespace wholehand {

// "0.1.1", from the build.
const char* version();

}  // namespace wholehand
