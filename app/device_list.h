// SPDX-License-Identifier: MIT
// What there is to compute on and to feel with, as lines that say how to ask for it.
#pragma once

#include <string>
#include <vector>

#include "device/gripper.h"

namespace wholehand {

// Prints the Vulkan devices and what each can do. Throws Error.
void print_devices();

// Grippers as lines for people, each ended.
std::string gripper_lines(const std::vector<GripperFound>& found);

}  // namespace wholehand
