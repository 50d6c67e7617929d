// SPDX-License-Identifier: MIT
// Which grippers there are, of every kind.
#pragma once

#include <string>
#include <vector>

#include "device/loop/gripper.h"

namespace wholehand {

// All of them, the simulated one first, and for each kind without a gripper one entry that says what was searched for and what is missing.
// `dhd_library`: path of Force Dimension's SDK, or empty (see load_dhd_library). Does not throw.
std::vector<GripperFound> find_grippers(const std::string& dhd_library);

}  // namespace wholehand
