// SPDX-License-Identifier: MIT
// The clock that loops and watches go by.
#pragma once

#include <ctime>

namespace wholehand {

// s since some moment; never steps.
inline double monotonic_now() noexcept {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace wholehand
