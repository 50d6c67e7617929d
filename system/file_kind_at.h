// SPDX-License-Identifier: MIT
// What a file is, by its path.
#pragma once

#include <string>

#include "core/file_kind.h"

namespace wholehand {

// Unknown also where no regular file is there that can be read. Waits for no pipe.
FileKind file_kind_at(const std::string& path);

}  // namespace wholehand
