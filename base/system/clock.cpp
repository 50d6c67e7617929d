// SPDX-License-Identifier: MIT
#include "base/system/clock.h"

#include <chrono>
#include <ctime>
#include <thread>

namespace wholehand {

double monotonic_now() noexcept {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void pause_for(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

}  // namespace wholehand
