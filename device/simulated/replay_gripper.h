// SPDX-License-Identifier: MIT
// A recorded session in place of a device.
#pragma once

#include <memory>
#include <vector>

#include "device/loop/gripper.h"

namespace wholehand::device {

// A gripper that replays a recording: each tick's value, timeout or error. It dictates the ticks' numbers, because a recorded session may have missed
// periods. A write fails if it failed then. The replay ends where the session did, and at a tick whose fault came from the loop itself (late, ring
// full, interrupted) and would not recur. `ticks` have ascending numbers.
std::unique_ptr<Gripper> make_replay(std::vector<Tick> ticks, GripperLimits limits);

}  // namespace wholehand::device
