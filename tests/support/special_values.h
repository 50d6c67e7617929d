// SPDX-License-Identifier: MIT
// Numbers that are none.
#pragma once

#include <limits>

namespace wholehand {

inline constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();
inline constexpr double INFINITE = std::numeric_limits<double>::infinity();

}  // namespace wholehand
