// SPDX-License-Identifier: MIT
// Haply's Inverse3 by the Inverse Service: two of them as the tips of thumb and index finger, or one with a VerseGrip. docs/devices.md has the protocol
// and its sources.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/scene.h"
#include "device/grippers/haply_service.h"
#include "device/loop/gripper.h"

namespace wholehand::device {

// The most of two devices: each tip bears half of the arm's force, the grip's and what is across, so that 8 / 2 + 6 = 10 N is exceeded only with a
// force across.
constexpr double TWO_TIPS_FORCE = 8, TWO_TIPS_GRIP = 6;  // N

// How the workspace is calibrated. Each device must first move, so that one that nobody holds does not count as still.
struct HaplyCalibration {
  double travel = 10e-3;  // m
  double still = 0.5;     // s
  double rest = 1e-3;     // m: what counts as still
  double patience = 30;   // s for all of it
};

// Opens the devices and calibrates the workspace: the person holds the tips together (or the grip) still at one place, which becomes the origin of
// the device frame. `say` gets lines for the user. The devices get zero force after `watchdog` s without a write. Throws Error (failure): no service,
// an old one, devices that are missing or cannot be told apart, or no calibration in time.
std::unique_ptr<Gripper> open_haply(const HaplyAddress& address, const Scene& scene, double watchdog,
                                    const std::function<void(const std::string&)>& say, const HaplyCalibration& calibration = {});

}  // namespace wholehand::device
