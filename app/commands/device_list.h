// SPDX-License-Identifier: MIT
// The devices and grippers of this machine, as lines that say how to select them.
#pragma once

#include <string>
#include <vector>

#include "device/loop/gripper.h"

namespace wholehand {

// Prints what can compute: the Vulkan devices with their abilities (or why there is none, and the remedy), and the core.
void print_devices();

// Grippers as lines for people, each ended.
std::string gripper_lines(const std::vector<device::GripperFound>& found);

}  // namespace wholehand
