// SPDX-License-Identifier: MIT
// The devices and grippers of this machine, as lines that say how to ask for them.
#pragma once

#include <string>
#include <vector>

#include "device/loop/gripper.h"

namespace wholehand {

// Prints what computes: the Vulkan devices and what each can do, or why there is none and what helps, and the core.
void print_devices();

// Grippers as lines for people, each ended.
std::string gripper_lines(const std::vector<GripperFound>& found);

}  // namespace wholehand
