// SPDX-License-Identifier: MIT
// Whether the process may open the files that it will need.
#pragma once

#include <cstddef>

namespace wholehand {

// Throws Error (failure) where fewer than `needed` further files can be open at once: libraries that find none left report something
// else, or nothing.
void check_open_files(std::size_t needed);

}  // namespace wholehand
