// SPDX-License-Identifier: MIT
// The hand of a live session: how a gripper's axes place it, and how it closes on a vessel.
#pragma once

#include <array>

#include "core/closure.h"

namespace wholehand::device {

// The hand whose gripper's axes are `rotation` and whose tips' middle is `middle` (vessel or world frame), at a closure; `scale` is the hand's total
// scale. `e1_x` as place_hand's.
core_f64::Placement place_live_hand(const core_f64::Hand& hand, double closure, const core_f64::Mat3& rotation,
                                    core_f64::Vec3 middle, double scale, double& e1_x);
// The hand with its tips at two contacts of a vessel that stands upright at `place` (all three in one frame; the answer is in the vessel's). The
// gripper's axes are turned so that the first lies along the contacts. A gap that the hand cannot make counts as the nearest that it can. Sets
// everything that rest_hand needs except the contacts' angles. `e1_x` as above.
core_f64::Closing close_live_hand(const core_f64::Hand& hand, const std::array<core_f64::Vec3, 2>& contacts, core_f64::Vec3 place,
                                  const core_f64::Mat3& rotation, double& e1_x);

}  // namespace wholehand::device
