// SPDX-License-Identifier: MIT
// Checks whether the process may open the files that it will need.
#pragma once

#include <cstddef>

namespace wholehand {

// Throws Error (failure) if fewer than `needed` further files can be open at once: libraries without a free descriptor report something else, or
// nothing.
void check_open_files(std::size_t needed);

}  // namespace wholehand
