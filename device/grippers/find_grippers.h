// SPDX-License-Identifier: MIT
// Finds grippers of every kind.
#pragma once

#include <string>
#include <vector>

#include "device/loop/gripper.h"

namespace wholehand::device {

// All grippers, the simulated one first. Each kind without a gripper has one entry that says what was searched for and what is missing.
// `dhd_library`: path of Force Dimension's SDK, or empty (see load_dhd_library). Does not throw.
std::vector<GripperFound> find_grippers(const std::string& dhd_library);

}  // namespace wholehand::device
