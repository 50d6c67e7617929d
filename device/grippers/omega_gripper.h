// SPDX-License-Identifier: MIT
// Force Dimension's omega.7 and sigma.7, for the right and the left hand, through the vendor's SDK.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "device/loop/gripper.h"

namespace wholehand::device {

// Converts between the SDK's frame (+x towards the person, +y to the right, +z up; CHAI3D, "Haptic devices", General conventions,
// https://chai3d.org/download/doc/html/chapter6-haptic-devices.html) and the device frame of device/session/tick.h (+x right, +y up, +z towards the
// person). The axes only change names, so lengths and handedness stay.
Triple from_dhd(const Triple& vector);
Triple to_dhd(const Triple& vector);
// The gripper's own axes change names likewise. The SDK's gripper opens along its own y: the index finger of a right hand is at +y, of a left hand at
// -y (CHAI3D, src/tools/CToolGripper.cpp), which is the +x of device/session/tick.h for both. `frame` as the SDK fills it, with the gripper's axes as
// columns.
Rotation rotation_from_dhd(const double frame[3][3]);

// Numbers of an address below OMEGA_DEVICES are those of the SDK; others are serial numbers.
constexpr int OMEGA_DEVICES = 32, LARGEST_OMEGA_SERIAL = 65535;

// Opens device `which` of those that the SDK counts (0: the first; below OMEGA_DEVICES), or the one with this serial number (from OMEGA_DEVICES on).
// The search for a serial number opens each device briefly that no other session has. The address is "omega" or "omega:WHICH". `library`: path of the SDK, or
// empty (see load_dhd_library). `watchdog_s`: without a new force for that long the device drops all force, whatever has become of this
// program; in steps of 125 us, 31.875 ms at most, and stderr reports a longer one.
//
// The name, and error texts of the SDK, are reduced to printable ASCII.
//
// read() answers value or error, never timeout: the SDK waits by itself and fails when the device is gone. It passes on a pose that is not finite,
// and the loop judges it. The SDK gives a measurement neither a number nor a time of its own. So `sequence` counts reads, a stale measurement looks
// like a device at rest, and `time` is the SDK's clock at the read.
// write() leaves the device without force until a read has succeeded; the first write after it enables force.
// panic() calls nothing: calls of the SDK lock and allocate, so no signal handler may make them. A second thread releases the force with
// release_from_watchdog(), and so does the device's watchdog.
//
// Throws Error (usage: a watchdog that is no positive time; failure: no SDK, no such device, another session has it, another model, or
// a device that takes no watchdog or not these maximum forces).
std::unique_ptr<Gripper> open_omega(const std::string& library, double watchdog_s, int which = 0);

// Every device that the SDK counts, opened briefly. Without SDK or device: one entry that says so. Does not throw.
std::vector<GripperFound> find_omega_grippers(const std::string& library);

}  // namespace wholehand::device
