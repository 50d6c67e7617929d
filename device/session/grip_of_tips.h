// SPDX-License-Identifier: MIT
// The six numbers of the grip that two tips make.
#pragma once

#include <array>
#include <optional>

#include "core/real.h"
#include "core/result.h"

namespace wholehand::device {

// The grip of two tips (thumb, index) and a gripper's axes, in the vessel's frame and the world of the right hand. Absent if the line of the tips
// runs along the vessel's axis.
std::optional<GripInput> grip_of_tips(const std::array<core_f64::Vec3, 2>& tips, const core_f64::Mat3& axes);

}  // namespace wholehand::device
