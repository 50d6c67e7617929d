// SPDX-License-Identifier: MIT
// The one clock: of loops, watches and everything above core/ that is timed. Waits on a condition or a queue take std::chrono's, which
// is the same.
#pragma once

#include <ctime>

namespace wholehand {

// s since some moment; never steps. A signal handler may ask, too.
inline double monotonic_now() noexcept {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace wholehand
