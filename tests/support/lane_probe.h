// SPDX-License-Identifier: MIT
// Whether a device counts useful lanes right (shaders/real.glsl).
#pragma once

#include "host/device.h"

namespace wholehand {

// Turns of a loop that lanes leave one by one: the useful ones, and all.
struct LaneCounts {
  std::uint32_t useful = 0, all = 0;
  bool operator==(const LaneCounts&) const = default;
};
LaneCounts counted_lanes(const host::Device& on);
// What they must be where subgroups are as large as the device says.
LaneCounts expected_lanes(const host::Device& on);

}  // namespace wholehand
