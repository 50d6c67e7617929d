// SPDX-License-Identifier: MIT
// The result of removing a gripper's force, and its wording.
#pragma once

#include <cstdint>
#include <string_view>

#include "device/loop/safe_line.h"

namespace wholehand::device {

enum class ReleaseResult : std::uint8_t {
  no_force,       // it had no force: never switched on, or the gripper discards forces
  written,        // the device accepted zero force
  refused,        // it was asked to accept zero force, and did not
  not_attempted,  // its library cannot be called at that moment
};

// Size of a force for messages, N: its magnitude at the arm and on each finger.
struct ForceSize {
  double arm = 0, grip = 0;
};

constexpr double UNKNOWN_WATCHDOG = -1;  // instead of a period: the watchdog is unknown

// "zero force was written"; or that it was not, with `last`, the previously written force, and what removes it: the device's watchdog of that period,
// s; 0: it has none; or UNKNOWN_WATCHDOG. `why`: the device's words, may be empty. Safe in a signal handler.
void add_force_words(SafeLine& line, ReleaseResult outcome, const ForceSize& last, double watchdog,
                     std::string_view why = {}) noexcept;

}  // namespace wholehand::device
