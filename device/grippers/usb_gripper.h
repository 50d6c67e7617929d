// SPDX-License-Identifier: MIT
// Open grippers over plain USB: libusb, one vendor interface with an interrupt endpoint each way.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "device/loop/gripper.h"

namespace wholehand::device {

// Opens the gripper with a vendor and product id, VVVV:PPPP in hexadecimal digits; empty: the first one found. The device releases its force if it
// hears nothing for `watchdog_s`, s. Throws Error: (usage) an invalid id or period; (failure) everything else: not there, not a gripper, no
// permission, in use by another session, another protocol version, no measurements.
std::unique_ptr<Gripper> open_usb(const std::string& vid_pid, double watchdog_s);

// Every USB device with a gripper's interface. Reads the identity of those not in use; does not throw.
std::vector<GripperFound> find_usb_grippers();

}  // namespace wholehand::device
