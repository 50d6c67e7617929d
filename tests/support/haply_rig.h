// SPDX-License-Identifier: MIT
// A gripper of Haply's devices, open and calibrated on the stand-in for their service.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/system/clock.h"
#include "core/vectors.h"
#include "device/grippers/haply_gripper.h"
#include "tests/stand_in/haply_service.h"
#include "tests/support/live_script.h"

namespace wholehand {

constexpr double LONG_WATCHDOG = 60;  // s: no force is dropped for want of a write

// Where the devices are calibrated, each in its own frame (Haply's).
inline stand_in::HaplyMotion haply_origin() {
  stand_in::HaplyMotion motion;
  motion.cursors[0] = {-0.1, 0.2, 0.1};
  motion.cursors[1] = {0.3, 0.1, 0.05};
  return motion;
}

// From there: each device by its own way.
inline stand_in::HaplyMotion haply_moved(const Triple& first, const Triple& second = {}) {
  stand_in::HaplyMotion motion = haply_origin();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    motion.cursors[0][axis] += first[axis];
    motion.cursors[1][axis] += second[axis];
  }
  return motion;
}

// Comes to the origin, rests there, and comes again, until `is_over`: a client that was too slow to see it once sees it again, and no two states of
// the way are so near that a client could take them for a rest.
inline std::function<stand_in::HaplyMotion(double)> haply_greeting(const std::atomic<bool>& is_over) {
  constexpr int STATES = 200;    // of the way, and of the rest
  constexpr double STEP = 3e-3;  // m
  return [&is_over, count = 0](double) mutable {
    const double left = is_over ? 0 : STEP * std::max(STATES - count++ % (2 * STATES), 0);
    return haply_moved({left, 0, 0}, {0, left, 0});
  };
}

inline constexpr device::HaplyCalibration QUICK_CALIBRATION{10e-3, 10e-3, 1e-3, 30};

struct HaplyRig {
  explicit HaplyRig(const stand_in::HaplyOptions& options = {}, double watchdog = LONG_WATCHDOG,
                    const Scene& rig_scene = live_scene(), const std::array<std::string, 2>& arms = {})
      : scene(rig_scene), service(options) {
    setenv("WHOLEHAND_LOCK_DIR", testing::TempDir().c_str(), 1);
    service.move(haply_greeting(is_calibrated));
    gripper = device::open_haply(
        {address().at, arms}, scene, watchdog, [this](const std::string& line) { said.push_back(line); }, QUICK_CALIBRATION);
    is_calibrated = true;
  }

  device::HaplyAddress address() const { return {{"127.0.0.1", service.port()}, {}}; }
  std::string place() const { return "haply:" + std::to_string(service.port()); }
  device::ReadOutcome read() { return gripper->read(state, tick++); }
  // Reads tick after tick until it holds. On a busy machine the service may be slow, so that silence is no end.
  bool reads_until(const std::function<bool()>& holds) {
    const double end = monotonic_now() + 60;
    while (monotonic_now() < end)
      if (read() == device::ReadOutcome::value && holds()) return true;
    return false;
  }
  // Reads until one fails.
  device::ReadOutcome first_failure(device::ReadOutcome wanted) {
    const double end = monotonic_now() + 60;
    device::ReadOutcome outcome = device::ReadOutcome::value;
    while (monotonic_now() < end && outcome != wanted) outcome = read();
    return outcome;
  }
  // Writes until the service has it on this device, N in Haply's frame; forces are sent with six decimals.
  bool arrives(const device::GripperForce& force, std::size_t arm, const Triple& wanted) {
    return service.wait([&] {
      gripper->write(force);
      return distance(service.force(arm), wanted) < 1e-6;
    });
  }
  bool has_zero() const {
    return service.wait([this] { return !service.has_force(); });
  }

  Scene scene;
  std::vector<std::string> said;
  std::atomic<bool> is_calibrated{false};
  stand_in::HaplyService service;
  std::unique_ptr<device::Gripper> gripper;
  device::GripperState state;
  std::int64_t tick = 0;
};

}  // namespace wholehand
