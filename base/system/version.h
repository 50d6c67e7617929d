// SPDX-License-Identifier: MIT
// The program's version, and the oldest version whose files it reads.
#pragma once

#include <string>

namespace wholehand {

// "0.4.0", from the build.
const char* version();

// Throws Error (usage) if a version before 0.4.0 wrote the file. The message has `subject` ("a.nc: "), that version and the remedy, "run the sweep
// again". Accepts any other text.
void check_version(const std::string& subject, const std::string& written_by, const char* remedy);

}  // namespace wholehand
