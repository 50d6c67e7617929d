// SPDX-License-Identifier: MIT
// What became of a gripper's force when it was to go, and the words for it.
#pragma once

#include <cstdint>
#include <string_view>

#include "device/loop/safe_line.h"

namespace wholehand {

enum class ReleaseResult : std::uint8_t {
  no_force,       // no force was on it: never switched on, or a gripper whose forces go nowhere
  written,        // the device took zero force
  refused,        // it was asked to take zero force, and did not
  not_attempted,  // its library cannot be called at that moment
};

// Size of a force for messages, N: its magnitude at the arm and on each finger.
struct ForceSize {
  double arm = 0, grip = 0;
};

constexpr double UNKNOWN_WATCHDOG = -1;  // instead of a period: the watchdog is unknown

// "zero force was written"; or that it was not, then with `last`, the force that was written before, and who takes it away: the device's watchdog
// of that period, s; 0: it has none; or UNKNOWN_WATCHDOG. `why`: the device's words, may be empty. Safe in a signal handler.
void add_force_words(SafeLine& line, ReleaseResult outcome, const ForceSize& last, double watchdog,
                     std::string_view why = {}) noexcept;

}  // namespace wholehand
