// SPDX-License-Identifier: MIT
// Open grippers over HID: hidapi on Linux hidraw nodes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "device/loop/gripper.h"

namespace wholehand::device {

// Opens the gripper at a node such as /dev/hidraw0; empty: the first one found. The device releases its force if it hears nothing for `watchdog_s`,
// s. Throws Error: (usage) a period that is not allowed; (failure) everything else: not there, not a gripper, no permission, in use by another
// session, another protocol version, no measurements.
std::unique_ptr<Gripper> open_hid(const std::string& path, double watchdog_s);

// Every HID device whose report descriptor is a gripper's. Reads the identity of those not in use; does not throw.
std::vector<GripperFound> find_hid_grippers();

}  // namespace wholehand::device
