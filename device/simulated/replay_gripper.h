// SPDX-License-Identifier: MIT
// A recorded session in the place of a device.
#pragma once

#include <memory>
#include <vector>

#include "device/loop/gripper.h"

namespace wholehand {

// A gripper that says again what was read then: each recorded tick's value, timeout or error. It dictates the numbers of the ticks, because a
// recorded session may have missed periods. A write fails where it failed then. It is done where the session was, and at a tick whose
// fault was the loop's own doing (late, ring full, interrupted) and would not happen again. `ticks` ascend in their numbers.
std::unique_ptr<Gripper> make_replay(std::vector<Tick> ticks, GripperLimits limits);

}  // namespace wholehand
