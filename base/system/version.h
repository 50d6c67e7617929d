// SPDX-License-Identifier: MIT
// The program's version, and those whose files it reads.
#pragma once

#include <string>

namespace wholehand {

// "0.4.0", from the build.
const char* version();

// Throws Error (usage) where a version before 0.4.0 wrote a file: `subject` ("a.nc: "), that version and the remedy, "run the sweep again". Any
// other text passes.
void check_version(const std::string& subject, const std::string& written_by, const char* remedy);

}  // namespace wholehand
